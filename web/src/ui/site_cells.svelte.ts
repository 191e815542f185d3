// The cells of maps. Over a weak link they take minutes: they are asked for once, one map at a time,
// and after a failure not at once again.

import { refusal_text } from '../model/answer';
import { say } from '../model/say';
import type { SiteMap, SiteMapCalls, TaggedCells } from '../model/site_map';

/** Of the map in use and of the one that is edited. */
const KEPT = 2;
/** After failures the wait doubles: a weak link has better things to carry. */
const AGAIN_MS = 5000;
const AT_LAST_MS = 300_000;

interface KnownCells {
  readonly id: number;
  readonly revision: number;
  readonly cells: TaggedCells;
}
/** What is asked for. */
interface Call {
  readonly id: number;
  readonly revision: number;
  readonly end: AbortController;
}

export class SiteCells {
  /** Why the wanted ones are not there; null: they are, or are under way. */
  failure = $state<string | null>(null);
  #known = $state.raw<readonly KnownCells[]>([]);
  readonly #calls: Pick<SiteMapCalls, 'cells'>;
  readonly #now_ms: () => number;
  #call: Call | null = null;
  /** When the one that failed last may be asked for again. */
  #failed: { readonly id: number; readonly revision: number; readonly due_ms: number } | null =
    null;
  #again_ms = AGAIN_MS;

  constructor(calls: Pick<SiteMapCalls, 'cells'>, now_ms = (): number => performance.now()) {
    this.#calls = calls;
    this.#now_ms = now_ms;
  }

  /** Also of a revision before: better than none until the new ones are there. */
  of(map: SiteMap): TaggedCells | null {
    return this.#known.find(({ id }) => id === map.id)?.cells ?? null;
  }

  /** Only what is not known yet comes over the link. @param map null: none is looked at */
  async want(map: SiteMap | null): Promise<void> {
    const same = (other: { readonly id: number; readonly revision: number } | null): boolean =>
      other !== null && other.id === map?.id && other.revision === map.revision;
    if (same(this.#call)) return;
    this.#call?.end.abort();
    this.#call = null;
    const known = this.#known.find(({ id }) => id === map?.id) ?? null;
    if (!map || same(known)) {
      this.failure = null;
      return;
    }
    if (!same(this.#failed)) this.#again_ms = AGAIN_MS;
    else if (this.#failed && this.#now_ms() < this.#failed.due_ms) return;
    await this.#fetch(map, known);
  }

  async #fetch({ id, revision }: SiteMap, known: KnownCells | null): Promise<void> {
    const call: Call = { id, revision, end: new AbortController() };
    this.#call = call;
    const answer = await this.#calls.cells(id, known?.cells.tag ?? null, call.end.signal);
    if (this.#call !== call) return; // another one is looked at by now
    this.#call = null;
    if (!answer.ok) {
      this.failure = say('the_map_is_not_drawn_refusal', { refusal: refusal_text(answer.refusal) });
      this.#failed = { id, revision, due_ms: this.#now_ms() + this.#again_ms };
      this.#again_ms = Math.min(2 * this.#again_ms, AT_LAST_MS);
      return;
    }
    this.failure = null;
    this.#failed = null;
    const cells = answer.value ?? known?.cells;
    const others = this.#known.filter((other) => other.id !== id);
    if (cells) this.#known = [{ id, revision, cells }, ...others].slice(0, KEPT);
  }
}
