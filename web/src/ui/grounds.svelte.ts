// The ground pictures: the list, the one that is shown, what is being brought, and where it lies.

import { failure_text, refusal_text, type Answer, type Refusal } from '../model/answer';
import {
  chosen_online,
  chosen_set,
  ground_of,
  kind_of_file,
  moved_shift,
  MOST_TILES,
  set_name,
  USUAL_TILE_BYTES,
  type Ground,
  type GroundChoice,
  type OnlineTiles,
  type TileCalls,
  type TileSet,
  type TileShelf,
} from '../model/ground';
import { file_size } from '../model/format';
import type { LatLon } from '../model/plan';
import type { DraftStorage } from '../model/ports';
import { say } from '../model/say';
import { count_tiles, tile_url, tiles_of, type Bounds, type TileAddress } from '../model/tiling';
import type { Dialogs } from './dialogs.svelte';
import type { Notices } from './notices.svelte';
import type { Cutter } from '../ortho/conversation';
import type { OrthoTrouble } from '../ortho/messages';
import { accuracy_mark, inexact_words, ortho_words } from '../ortho/words';

const PIECE_BYTES = 1024 * 1024;
const AGAIN_AFTER_MS = 3000;
/** So many pieces or tiles in a row that do not come through end it. */
const MOST_FAILED = 20;

type Far = 'robot' | 'network';

/** What is being brought to the robot. */
export interface Bringing {
  readonly name: string;
  /** 0 to 1. */
  readonly share: number;
  /** For whom, while nothing comes through; null: it does. */
  readonly waits: Far | null;
}

const EMPTY: TileShelf = { items: [], unfinished: [], online: [] };
const pause = (ms: number): Promise<void> => new Promise((resolve) => setTimeout(resolve, ms));

export class Grounds {
  shelf = $state.raw<TileShelf>(EMPTY);
  failure = $state<string | null>(null);
  choice = $state<GroundChoice>('');
  bringing = $state.raw<Bringing | null>(null);
  /** Whence the shown one comes, no picture does. */
  silent = $state(false);
  shown = $derived.by<Ground | null>(() => ground_of(this.shelf, this.choice));
  set = $derived.by<TileSet | null>(() => chosen_set(this.shelf, this.choice));
  online = $derived.by<OnlineTiles | null>(() => chosen_online(this.shelf, this.choice));

  readonly #calls: TileCalls;
  readonly #storage: DraftStorage;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;
  #given_up = false;

  constructor(calls: TileCalls, storage: DraftStorage, notices: Notices, dialogs: Dialogs) {
    this.#calls = calls;
    this.#storage = storage;
    this.#notices = notices;
    this.#dialogs = dialogs;
    this.choice = storage.read() ?? '';
  }

  async refresh(): Promise<void> {
    const answer = await this.#calls.list();
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (answer.ok) this.shelf = answer.value;
  }

  choose(choice: GroundChoice): void {
    this.choice = choice;
    this.#storage.write(choice);
  }

  give_up(): void {
    this.#given_up = true;
  }

  /** Files of map tiles, and orthophotos. */
  async bring(files: readonly File[]): Promise<void> {
    if (this.bringing) return this.#notices.show('warning', say('ground_one_after_the_other'));
    for (const file of files) {
      const kind = kind_of_file(new Uint8Array(await file.slice(0, 16).arrayBuffer()));
      if (kind === null) {
        this.#notices.show('error', say('ground_is_neither', { name: file.name }));
        continue;
      }
      await this.#while_bringing(file.name, () =>
        kind === 'mbtiles' ? this.#send(file) : this.#cut(file),
      );
    }
  }

  /** What the map shows of the network, for where there is none. */
  async keep_area(online: OnlineTiles, bounds: Bounds, from: number, to: number): Promise<void> {
    if (this.bringing) return this.#notices.show('warning', say('ground_one_after_the_other'));
    const count = count_tiles(bounds, from, to);
    if (count > MOST_TILES) {
      return this.#notices.show('error', say('ground_area_too_large', { count, most: MOST_TILES }));
    }
    const sure = await this.#dialogs.ask({
      title: say('ground_keep_area'),
      text: say('ground_keep_area_text', {
        count,
        size: file_size(count * USUAL_TILE_BYTES),
        name: online.name,
      }),
      yes: say('ground_keep'),
      danger: false,
    });
    if (!sure) return;
    await this.#while_bringing(online.name, () =>
      this.#keep(online, [...tiles_of(bounds, from, to)]),
    );
  }

  /** The robot stands on what the picture shows at `shown`. @return it was moved */
  async align(shown: LatLon, robot: LatLon): Promise<boolean> {
    const { set } = this;
    if (!set) return false;
    const shift_m = moved_shift(set.shift_m, shown, robot);
    const [east, north] = moved_shift([0, 0], shown, robot);
    const sure = await this.#dialogs.ask({
      title: say('ground_align'),
      text: say('ground_align_text', {
        name: set.name,
        distance: Math.hypot(east, north).toFixed(2),
      }),
      yes: say('ground_move_it'),
      danger: false,
    });
    return sure && this.move(set, shift_m);
  }

  move = (set: TileSet, shift_m: readonly number[]): Promise<boolean> =>
    this.#changed(say('done_changed'), this.#calls.change(set.set, { shift_m }));

  rename = (set: TileSet, name: string): Promise<boolean> =>
    this.#changed(say('done_changed'), this.#calls.change(set.set, { name }));

  async remove(set: TileSet): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: say('ground_delete', { name: set.name }),
      text: say('ground_delete_text', { size: file_size(set.bytes) }),
      yes: say('delete_it'),
      danger: true,
    });
    if (sure) await this.#changed(say('done_deleted'), this.#calls.remove(set.set));
  }

  async #changed(done: string, call: Promise<Answer<unknown>>): Promise<boolean> {
    const answer = await call;
    this.#notices.outcome(`ground ${done}`, answer.ok ? null : failure_text(done, answer.refusal));
    await this.refresh();
    return answer.ok;
  }

  async #while_bringing(name: string, work: () => Promise<string | null>): Promise<void> {
    this.#given_up = false;
    this.bringing = { name, share: 0, waits: null };
    const trouble = await work();
    this.bringing = null;
    this.#notices.outcome(`ground ${name}`, trouble);
    await this.refresh();
  }

  #tell(share: number, waits: Far | null = null): void {
    if (this.bringing) this.bringing = { ...this.bringing, share, waits };
  }

  /** As long as the link fails it is tried again. @return what is in the way; null: nothing */
  async #insist<T>(call: () => Promise<Answer<T>>, of: Far = 'robot'): Promise<Answer<T> | null> {
    for (let failed = 0; ; failed++) {
      const answer = await call();
      const lost = !answer.ok && (answer.refusal.status === 0 || answer.refusal.status === 429);
      if (!lost || failed >= MOST_FAILED) return answer;
      this.#tell(this.bringing?.share ?? 0, of);
      await pause(AGAIN_AFTER_MS);
      if (this.#given_up) return null;
    }
  }

  #names(): readonly string[] {
    return this.shelf.items.map(({ set }) => set);
  }

  /** A file as it is, piece by piece; what came is not sent again. */
  async #send(file: File): Promise<string | null> {
    const set = set_name(file.name, this.#names());
    let offset = 0;
    while (!this.#given_up) {
      const answer = await this.#insist(() =>
        this.#calls.send(set, offset, file.size, file.slice(offset, offset + PIECE_BYTES)),
      );
      if (answer === null) break;
      if (!answer.ok) {
        const at = answer.refusal.status === 409 ? await this.#received(set) : null;
        if (at === null || at === offset) return this.#refused(file.name, answer.refusal);
        offset = at; // its last answer was lost on the way
        continue;
      }
      if (answer.value) {
        this.choose(`set:${set}`);
        this.#notices.show('good', say('ground_is_there', { name: answer.value.name }));
        return null;
      }
      offset = Math.min(file.size, offset + PIECE_BYTES);
      this.#tell(offset / file.size);
    }
    await this.#calls.remove(set);
    return null;
  }

  async #received(set: string): Promise<number | null> {
    const answer = await this.#insist(() => this.#calls.list());
    if (!answer?.ok) return null;
    return answer.value.unfinished.find((one) => one.set === set)?.received_bytes ?? null;
  }

  #refused(name: string, refusal: Refusal): string {
    return say('ground_is_not_taken', { name, why: refusal_text(refusal) });
  }

  async #cut(file: File): Promise<string | null> {
    const { start_cutter } = await import('../ortho/conversation');
    const cutter = start_cutter();
    try {
      return await this.#cut_by(cutter, file);
    } finally {
      cutter.end();
    }
  }

  async #cut_by(cutter: Cutter, file: File): Promise<string | null> {
    const seen = await cutter.look(file);
    const words = (why: OrthoTrouble, detail: string): string =>
      say('ground_is_not_taken', { name: file.name, why: ortho_words(why, detail) });
    if ('why' in seen) return words(seen.why, seen.detail);
    const name = file.name.replace(/\.[a-z]+$/i, '');
    const set = set_name(file.name, this.#names());
    const { format } = seen;
    const attribution = seen.datum ? accuracy_mark(seen.datum) : '';
    const made = await this.#insist(() => this.#calls.create({ set, name, format, attribution }));
    if (!made?.ok) return made ? this.#refused(file.name, made.refusal) : null;
    let refusal: Refusal | null = null;
    const trouble = await cutter.cut(async ({ at, picture, done }) => {
      const answer = await this.#insist(() => this.#calls.put(set, at, picture));
      if (answer && !answer.ok) refusal = answer.refusal;
      this.#tell(done / seen.tiles);
      return answer?.ok === true && !this.#given_up;
    });
    if (refusal !== null || trouble || this.#given_up) {
      await this.#calls.remove(set); // half a picture is none
      if (refusal !== null) return this.#refused(file.name, refusal);
      return trouble && words(trouble.why, trouble.detail);
    }
    this.choose(`set:${set}`);
    if (seen.datum) this.#notices.show('warning', inexact_words(name, seen.datum));
    else this.#notices.show('good', say('ground_is_there', { name }));
    return null;
  }

  async #keep(online: OnlineTiles, addresses: readonly TileAddress[]): Promise<string | null> {
    const set = set_name(online.name, this.#names());
    let format: 'png' | 'jpg' | 'webp' | null = null;
    let kept = 0;
    let missing = 0;
    for (const [k, at] of addresses.entries()) {
      if (this.#given_up) break;
      const picture = await this.#insist(
        () => this.#calls.fetch(tile_url(online.url, at)),
        'network',
      );
      if (!picture?.ok) {
        if (picture) return this.#refused(online.name, picture.refusal);
        break;
      }
      this.#tell((k + 1) / addresses.length);
      const blob = picture.value;
      if (blob === null) {
        missing += 1;
        continue;
      }
      if (format === null) {
        format = await format_of(blob);
        if (format === null) return say('ground_network_no_picture', { name: online.name });
        const { name, attribution } = online;
        const made = await this.#insist(() =>
          this.#calls.create({ set, name, format: format ?? 'png', attribution }),
        );
        if (!made?.ok) return made && this.#refused(name, made.refusal);
      }
      const answer = await this.#insist(() => this.#calls.put(set, at, blob));
      if (!answer?.ok) return answer && this.#refused(online.name, answer.refusal);
      kept += 1;
    }
    if (kept > 0 && missing > 0) {
      this.#notices.show('good', say('ground_area_kept', { kept, missing }));
    } else if (kept > 0) this.#notices.show('good', say('ground_area_whole', { kept }));
    else if (!this.#given_up) return say('ground_network_no_picture', { name: online.name });
    return null;
  }
}

/** By its first bytes: what a server says of it is not always so. */
const format_of = async (blob: Blob): Promise<'png' | 'jpg' | 'webp' | null> => {
  const head = new Uint8Array(await blob.slice(0, 12).arrayBuffer());
  if (head[0] === 0x89 && head[1] === 0x50) return 'png';
  if (head[0] === 0xff && head[1] === 0xd8) return 'jpg';
  return head[8] === 0x57 && head[9] === 0x45 ? 'webp' : null;
};
