// What the robot sees: which layers are shown, the newest of each, and the sensors' health.

import { untrack } from 'svelte';

import { refusal_text } from '../model/answer';
import { obstacle_place, sound_of } from '../model/obstacle';
import type { DraftStorage } from '../model/ports';
import {
  changes_guard,
  guard_line,
  layers_from,
  rates_of,
  type AheadOnMap,
  type Layers,
  type SeenCalls,
  type SeenEvents,
  type SeenGrid,
  type SeenLink,
  type SeenOnMap,
  type SeenScan,
  type SeenThing,
  type Sensor,
} from '../model/seen';
import { sweep_of, type Sweep } from '../model/sweep';
import { robot_place } from '../model/vehicle';
import { again_and_again } from './again_and_again';
import type { Live } from './live.svelte';
import { speaker } from './sound';

const RENEWED_MS = 2000;
/** Older than this it is not shown: what was there may be gone. */
const OLD_MS = 2500;

export class Seen {
  layers = $state.raw<Layers>(layers_from(null));
  sensors = $state.raw<readonly Sensor[]>([]);
  failure = $state<string | null>(null);
  #grid = $state.raw<SeenGrid | null>(null);
  #scan = $state.raw<SeenScan | null>(null);
  #things = $state.raw<readonly SeenThing[]>([]);
  #came_ms = $state(-Infinity);
  /** How many cards show what each sensor sees. */
  #lookers = $state(0);

  /** For what a card asks itself, while it is open. */
  readonly calls: SeenCalls;
  readonly #link: SeenLink;
  readonly #live: Live;
  readonly #storage: DraftStorage;

  constructor(calls: SeenCalls, link: SeenLink, live: Live, storage: DraftStorage) {
    this.calls = calls;
    this.#link = link;
    this.#live = live;
    this.#storage = storage;
    this.layers = layers_from(storage.read());
  }

  /** The robot has sensors that look around. */
  has = $derived.by<boolean>(() => (this.#live.capabilities?.guard ?? null) !== null);
  /** How near the guard lets it come; null: it has no sensors. */
  guard_line = $derived.by<string | null>(() => {
    const guard = this.#live.capabilities?.guard ?? null;
    return guard === null ? null : guard_line(guard);
  });
  #fresh = $derived.by<boolean>(() => this.#live.now_ms - this.#came_ms < OLD_MS);
  things = $derived.by<readonly SeenThing[]>(() => (this.#fresh ? this.#things : []));
  on_map = $derived.by<SeenOnMap | null>(() => {
    if (!this.has || !this.#fresh) return null;
    const { grid, scan } = this.layers;
    return {
      grid: grid ? this.#grid : null,
      scan: scan ? this.#scan : null,
      things: grid ? this.#things : [],
    };
  });
  ahead = $derived.by<AheadOnMap | null>(() => this.#ahead());

  readonly stream_events: SeenEvents = {
    on_grid: (grid) => {
      this.#grid = grid;
      this.#came_ms = performance.now();
    },
    on_scan: (scan) => {
      this.#scan = scan;
      this.#came_ms = performance.now();
    },
    on_things: ({ items }) => {
      this.#things = items;
      this.#came_ms = performance.now();
    },
  };

  show(change: Partial<Layers>): void {
    this.layers = { ...this.layers, ...change };
    this.#storage.write(JSON.stringify(this.layers));
  }

  /** Asks the stream for what is shown, and for no more. */
  follow_layers(): void {
    const scan = this.layers.scan || this.#lookers > 0;
    this.#link.watch(this.has ? rates_of({ ...this.layers, scan }) : {});
    if (!this.layers.grid) this.#grid = null;
    if (!scan) this.#scan = null;
  }

  /** What each sensor sees now, also where it is not drawn on the map; null: nothing that is new. */
  scan = $derived.by<SeenScan | null>(() => (this.#fresh ? this.#scan : null));

  /** As long as a card shows it. @return ends it */
  look_at_sensors(): () => void {
    untrack(() => (this.#lookers += 1));
    return () => (this.#lookers -= 1);
  }

  on_event(kind: string): void {
    const sound = sound_of(kind);
    if (sound && this.layers.sound) speaker.play(sound);
    if (this.has && changes_guard(kind)) void this.#reckon_anew();
  }

  async #reckon_anew(): Promise<void> {
    const answer = await this.calls.capabilities();
    if (answer.ok) this.#live.capabilities = answer.value;
  }

  /** Asks for the sensors' health now and then. @return ends it */
  watch(): () => void {
    return again_and_again(async () => {
      const answer = await this.calls.sensors();
      return () => {
        this.failure = answer.ok ? null : refusal_text(answer.refusal);
        if (answer.ok) this.sensors = answer.value.items;
      };
    }, RENEWED_MS);
  }

  #sweep(): Sweep | null {
    const { vehicle, capabilities } = this.#live;
    if (!vehicle?.armed || !vehicle.command || !capabilities?.guard) return null;
    const at = robot_place(vehicle);
    const { heading_deg } = vehicle.position;
    return sweep_of(at, heading_deg, vehicle.command, capabilities.size, capabilities.guard);
  }

  #ahead(): AheadOnMap | null {
    const { vehicle } = this.#live;
    if (!vehicle || !this.has || this.#live.stale) return null;
    const { obstacle } = vehicle;
    const place = obstacle_place(obstacle, robot_place(vehicle), vehicle.position.heading_deg);
    return {
      sweep: this.#sweep(),
      block: place && { ...place, stops: obstacle?.action === 'stop' },
      detour: (vehicle.detour ?? []).map(([lat = 0, lon = 0]) => ({ lat, lon })),
    };
  }
}
