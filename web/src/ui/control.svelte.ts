// Control as this browser sees it: who has it, and what may be done about that.

import { failure_text, type Answer } from '../model/answer';
import {
  present_lines,
  seat_of,
  seat_words,
  told_of,
  why_no_control,
  type ControlCalls,
  type ControlState,
  type TakeWish,
} from '../model/control';
import { say } from '../model/say';
import { again_and_again } from './again_and_again';

/** Between two looks. */
const HERE_MS = 3000;

const NOBODY: ControlState = { on: true, holder: null, requests: [] };

export class ControlDesk {
  state = $state.raw<ControlState>(NOBODY);
  here = $state.raw<readonly { key: string; words: string }[]>([]);
  /** Not known yet. */
  known = $state(false);
  busy = $state(false);
  /** What went wrong, or what others did. */
  told = $state('');
  seat = $derived.by(() => seat_of(this.state, this.#me));
  /** Why commands of this page are refused now; null: they are not, or it is not known. */
  no_control = $derived.by<string | null>(() =>
    this.known ? why_no_control(this.seat, this.drives, this.state) : null,
  );
  words = $derived.by(() =>
    this.known ? seat_words(this.state, this.#me) : say('control_not_known'),
  );

  readonly #calls: ControlCalls;
  readonly #me: string;

  /** May take it; a viewer watches. */
  readonly drives: boolean;

  /** @param me the id of this browser's session */
  constructor(calls: ControlCalls, me: string, role: string) {
    this.drives = role !== 'viewer';
    this.#calls = calls;
    this.#me = me;
  }

  take_message = (state: ControlState): void => {
    this.state = state;
    this.known = true;
    const told = told_of(state, this.#me);
    if (told !== '') this.told = told;
  };

  /** Who is connected, asked now and then while somebody looks. @return ends it */
  watch_here(): () => void {
    return again_and_again(async () => {
      const answer = await this.#calls.state();
      return () => {
        if (answer.ok) this.here = present_lines(answer.value, this.#me);
      };
    }, HERE_MS);
  }

  take = (wish: TakeWish = {}): Promise<boolean> =>
    this.#do(say('done_taken'), () => this.#calls.take(wish));
  release = (): Promise<boolean> => this.#do(say('given_up'), () => this.#calls.release());
  answer = (request: number, accept: boolean): Promise<boolean> =>
    this.#do(say('done_answered'), () => this.#calls.hand_over(request, accept));

  async #do(what: string, call: () => Promise<Answer<ControlState>>): Promise<boolean> {
    if (this.busy) return false;
    this.busy = true;
    this.told = '';
    const answer = await call();
    this.busy = false;
    // What came of it the stream tells, in the order in which it happened.
    if (!answer.ok) this.told = failure_text(what, answer.refusal);
    return answer.ok;
  }
}
