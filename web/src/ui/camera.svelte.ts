// What the camera shows: asks for the newest picture, again and again, while it is looked at.

import {
  AGAIN_MS,
  chosen,
  choice_of,
  FAILED_MS,
  FIRST_PACE,
  next_pace,
  PATIENCE_MS,
  taken_ms,
  type Camera,
  type CameraCalls,
} from '../model/camera';
import type { DraftStorage } from '../model/ports';

const LOOK_FOR_CAMERAS_MS = 10_000;
const TICK_MS = 100;

export class CameraWatch {
  cameras = $state.raw<readonly Camera[]>([]);
  on = $state(true);
  wanted = $state<string | null>(null);
  /** Of the picture that is shown. */
  url = $state<string | null>(null);
  taken = $state<number | null>(null);
  now = $state(performance.now());
  readonly camera = $derived(chosen(this.cameras, this.wanted));
  readonly #calls: CameraCalls;
  readonly #storage: DraftStorage;

  constructor(calls: CameraCalls, storage: DraftStorage) {
    this.#calls = calls;
    this.#storage = storage;
    const { on, name } = choice_of(storage.read());
    this.on = on;
    this.wanted = name;
  }

  choose(choice: { on?: boolean; name?: string }): void {
    this.on = choice.on ?? this.on;
    this.wanted = choice.name ?? this.wanted;
    this.#storage.write(JSON.stringify({ on: this.on, name: this.wanted }));
  }

  /** Which there are. @return ends it */
  find(): () => void {
    const ask = async (): Promise<void> => {
      if (document.visibilityState !== 'visible') return;
      const answer = await this.#calls.list();
      if (answer.ok) this.cameras = answer.value;
    };
    void ask();
    const timer = setInterval(() => void ask(), LOOK_FOR_CAMERAS_MS);
    return () => clearInterval(timer);
  }

  /** The pictures of one. @return ends it */
  watch(name: string): () => void {
    const over = new AbortController();
    const clock = setInterval(() => (this.now = performance.now()), TICK_MS);
    void this.#run(name, over.signal);
    return () => {
      over.abort();
      clearInterval(clock);
      this.#show(null);
      this.taken = null;
    };
  }

  async #run(name: string, over: AbortSignal): Promise<void> {
    const wait = (ms: number): Promise<void> => new Promise((done) => setTimeout(done, ms));
    let pace = FIRST_PACE;
    let count: number | null = null;
    while (!over.aborted) {
      if (document.visibilityState !== 'visible') {
        await wait(FAILED_MS);
        continue;
      }
      const asked = performance.now();
      const signal = AbortSignal.any([over, AbortSignal.timeout(PATIENCE_MS)]);
      const glimpse = await this.#calls.look(name, count, pace.divisor, signal);
      if (over.aborted) return;
      if (glimpse === null) {
        pace = next_pace(pace, performance.now() - asked);
        await wait(FAILED_MS);
        continue;
      }
      this.taken = taken_ms(asked, glimpse);
      if (glimpse.picture === null) {
        await wait(AGAIN_MS);
        continue;
      }
      count = glimpse.count;
      pace = next_pace(pace, performance.now() - asked);
      this.#show(URL.createObjectURL(new Blob([glimpse.picture], { type: 'image/jpeg' })));
    }
  }

  #show(url: string | null): void {
    if (this.url !== null) URL.revokeObjectURL(this.url);
    this.url = url;
  }
}
