// Short messages to the person, and the log of what happened.

import { robot_says } from '../model/robot_words';
import { plain_devices } from '../model/control';
import { title_before } from '../model/news';
import { say } from '../model/say';
import { ended_driving, event_about, event_key, worth_a_word } from '../model/happened';
import type { StationEvent } from '../model/vehicle';

export type Level = 'info' | 'good' | 'warning' | 'error';

export interface Notice {
  readonly id: number;
  readonly level: Level;
  readonly text: string;
  /** Two about the same are one: the newer. */
  readonly about: string | null;
  /** Of something that was tried: over once the person does the next thing. */
  readonly passing: boolean;
}

/** Errors stay until they are dismissed, or until what is done next. */
const SHOWN_MS: Record<Exclude<Level, 'error'>, number> = { info: 4000, good: 4000, warning: 8000 };
const AT_MOST = 4;
const LOG_LINES = 500;

const MISSED_AT_MOST = 2;

const words_of = (event: StationEvent): string => {
  const title = title_before(event.kind);
  const detail = plain_devices(robot_says(event.detail));
  return title === null ? detail : `${title}: ${detail}`;
};

export class Notices {
  shown = $state.raw<readonly Notice[]>([]);
  /** Newest first. */
  log = $state.raw<readonly StationEvent[]>([]);
  #next = 1;

  /** When what it knows of last happened. */
  get looked(): string {
    return this.log[0]?.time ?? '';
  }

  /** @param said words that are looked up whenever they are drawn follow the language of the page */
  show(
    level: Level,
    said: string | (() => string),
    about: string | null = null,
    passing = false,
  ): void {
    const words = typeof said === 'string' ? (): string => said : said;
    const text = words();
    const rest = this.shown.filter(
      (notice) => notice.text !== text && (about === null || notice.about !== about),
    );
    const notice: Notice = {
      id: this.#next,
      level,
      about,
      passing,
      get text() {
        return words();
      },
    };
    this.#next += 1;
    this.shown = [...rest, notice].slice(-AT_MOST);
    if (level !== 'error') setTimeout(() => this.dismiss(notice.id), SHOWN_MS[level]);
  }

  /** What came of an attempt: its failure, or none, and then those before it are over. */
  outcome(about: string, failure: string | null): void {
    if (failure === null) this.shown = this.shown.filter((notice) => notice.about !== about);
    else this.show('error', failure, about);
  }

  /** The same of what matters only until something else is done. */
  tried(about: string, failure: string | null): void {
    if (failure === null) this.outcome(about, null);
    else this.show('error', failure, about, true);
  }

  /** The person does something else. */
  move_on(): void {
    if (this.shown.some(({ passing }) => passing)) {
      this.shown = this.shown.filter(({ passing }) => !passing);
    }
  }

  dismiss(id: number): void {
    this.shown = this.shown.filter((notice) => notice.id !== id);
  }

  /** An event just happened: into the log, and on the screen. @return false: it was known */
  event(event: StationEvent): boolean {
    if (this.#enter([event]).length === 0) return false;
    if (worth_a_word(event)) {
      const level = event.level === 'error' ? 'warning' : event.level;
      this.show(level, () => words_of(event), event_about(event));
    }
    return true;
  }

  /** Events from before this page looked. @param missed_since the page had looked until then: what ended
   * the driving after it stays on the screen until it was read; null: it had not */
  past_events(events: readonly StationEvent[], missed_since: string | null): void {
    const fresh = this.#enter(events);
    if (missed_since === null) return;
    const away = fresh.filter((event) => event.time > missed_since && ended_driving(event));
    for (const event of away.slice(-MISSED_AT_MOST))
      this.show('error', () => say('meanwhile_text', { text: words_of(event) }));
  }

  /** @return those that were new */
  #enter(events: readonly StationEvent[]): readonly StationEvent[] {
    const known = new Set(this.log.map(event_key));
    const fresh = events.filter((event) => !known.has(event_key(event)));
    if (fresh.length > 0) {
      const newest_first = (a: StationEvent, b: StationEvent): number =>
        a.time < b.time ? 1 : a.time > b.time ? -1 : 0;
      this.log = [...fresh.toReversed(), ...this.log].sort(newest_first).slice(0, LOG_LINES);
    }
    return fresh;
  }
}
