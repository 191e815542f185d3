// The robot's parameters: what they are, and what a person changes in them.

import { failure_text, refusal_text } from '../model/answer';
import {
  compared,
  file_of,
  grouped,
  typed,
  type Compared,
  type Parameter,
  type ParameterCalls,
  type ParameterValue,
} from '../model/parameters';
import { say } from '../model/say';

export class Parameters {
  all = $state.raw<readonly Parameter[]>([]);
  text = $state('');
  changed_only = $state(false);
  groups = $derived(grouped(this.all, this.text, this.changed_only));
  failure = $state<string | null>(null);
  /** What came of the last change of each. */
  said = $state.raw<ReadonlyMap<string, string>>(new Map());
  /** A file was read, and waits for a word. */
  file = $state.raw<{ readonly name: string; readonly compared: Compared } | null>(null);
  busy = $state(false);

  readonly #calls: ParameterCalls;

  constructor(calls: ParameterCalls) {
    this.#calls = calls;
  }

  refresh = async (): Promise<void> => {
    const answer = await this.#calls.list();
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (answer.ok) this.all = answer.value;
  };

  /** @return false: it is as it was */
  async change(one: Parameter, text: string): Promise<boolean> {
    const value = typed(one, text);
    if (value.ok) return this.#set(one.name, value.value);
    this.#say(one.name, say('not_changed_it_why', { why: value.why }));
    return false;
  }

  reset = (one: Parameter): Promise<boolean> => this.#set(one.name, one.default);

  /** To be kept on the device. */
  get as_file(): Blob {
    return new Blob([file_of(this.all)], { type: 'application/json' });
  }

  async read(file: File): Promise<void> {
    await this.refresh();
    const found = compared(await file.text(), this.all);
    this.failure = typeof found === 'string' ? `“${file.name}”: ${found}` : this.failure;
    this.file = typeof found === 'string' ? null : { name: file.name, compared: found };
  }

  /** One after the other; what the robot refuses stays in the list, with its words. */
  async take_file(): Promise<void> {
    if (!this.file || this.busy) return;
    const { name, compared: found } = this.file;
    this.busy = true;
    const left = [];
    for (const one of found.differ) {
      if (!(await this.#set(one.parameter.name, one.value))) left.push(one);
    }
    this.busy = false;
    this.file = left.length > 0 ? { name, compared: { ...found, differ: left } } : null;
  }

  async #set(name: string, value: ParameterValue): Promise<boolean> {
    const answer = await this.#calls.set(name, value);
    if (!answer.ok) {
      this.#say(name, failure_text(say('done_changed'), answer.refusal));
      return false;
    }
    const { acted, waits_for, ...now } = answer.value;
    this.all = this.all.map((one) => (one.name === name ? { ...one, ...now } : one));
    this.#say(
      name,
      acted ? say('it_acts_now') : (waits_for ?? say('kept_it_acts_at_the_next_start')),
    );
    return true;
  }

  #say(name: string, words: string): void {
    this.said = new Map(this.said).set(name, words);
  }
}
