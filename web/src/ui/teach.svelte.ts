// The recording of a driven way: start, pause, keep as a mission, forget.

import { type Answer, failure_text } from '../model/answer';
import { count } from '../model/format';
import type { TeachCalls } from '../model/ports';
import { say } from '../model/say';
import type { Dialogs } from './dialogs.svelte';
import type { Editor } from './editor.svelte';
import type { Notices } from './notices.svelte';

const ASK_AGAIN_MS = 2000;

export class Teacher {
  name = $state('');
  /** Why nothing is recorded now. */
  waiting = $state<string | null>(null);
  busy = $state(false);

  readonly #calls: TeachCalls;
  readonly #editor: Editor;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;

  constructor(calls: TeachCalls, editor: Editor, notices: Notices, dialogs: Dialogs) {
    this.#calls = calls;
    this.#editor = editor;
    this.#notices = notices;
    this.#dialogs = dialogs;
  }

  start = (): Promise<boolean> =>
    this.#do(say('done_recorded'), () => this.#calls.start(this.name.trim()));
  pause = (): Promise<boolean> => this.#do(say('done_paused'), () => this.#calls.pause());
  resume = (): Promise<boolean> => this.#do(say('done_resumed'), () => this.#calls.resume());

  /** Makes a mission of it and, where nothing is lost by it, puts it into the editor. */
  async stop(): Promise<void> {
    await this.#do(say('done_kept'), async () => {
      const answer = await this.#calls.stop();
      if (!answer.ok) return answer;
      const mission = answer.value;
      const items = count(mission.items.length, 'item');
      this.#notices.show('good', say('kept_the_way_as_name_items', { name: mission.name, items }));
      this.name = '';
      if (!this.#editor.unsaved) this.#editor.show_mission(mission);
      return answer;
    });
  }

  async discard(points: number): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: say('forget_the_recorded_way'),
      text: say('points_will_be_gone_for_good', { points: count(points, 'point') }),
      yes: say('forget_it'),
      danger: true,
    });
    if (sure) await this.#do(say('done_forgotten'), () => this.#calls.discard());
  }

  /** Asks why nothing is recorded, as long as somebody looks. @return ends it */
  watch(): () => void {
    const ask = async (): Promise<void> => {
      const answer = await this.#calls.waiting();
      if (answer.ok) this.waiting = answer.value;
    };
    void ask();
    const timer = setInterval(() => void ask(), ASK_AGAIN_MS);
    return () => clearInterval(timer);
  }

  async #do(what: string, call: () => Promise<Answer<unknown>>): Promise<boolean> {
    if (this.busy) return false;
    this.busy = true;
    const answer = await call();
    this.busy = false;
    this.#notices.outcome(`teach ${what}`, answer.ok ? null : failure_text(what, answer.refusal));
    return answer.ok;
  }
}
