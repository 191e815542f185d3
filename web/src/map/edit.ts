// The hand on the map. What a press means depends on the mode; exactly one is active:
//
//   watch  a tap on a point selects it; one on free ground marks the place
//   edit   also: dragging a point moves it; dragging or tapping a "+" inserts one
//   draw   also: a tap on free ground adds a waypoint at the end
//   point  a press shows a place, and where it is dragged to a direction
//
// Nothing is changed here: a drag shows where the point would go, and its end is reported once.

import type MapBrowserEvent from 'ol/MapBrowserEvent';
import PointerInteraction from 'ol/interaction/Pointer';

import type { LatLon } from '../model/plan';
import type { MapEvents, MapMode } from '../model/ports';
import { leg } from './band';
import { HANDLE_FROM_PX, type DrawnPlan } from './plan_painter';
import { from_plane, type PlanePoint } from './projection';

/** A gloved finger needs more room than a mouse. */
const REACH_PX = { mouse: 18, touch: 28 } as const;
const HANDLE_REACH_PX = { mouse: 12, touch: 22 } as const;
/** Nearer to where the press began no direction is meant. */
const TURN_FROM_PX = 16;
const DRAG_FROM_PX = { mouse: 3, touch: 9 } as const;

type Pixel = readonly [x: number, y: number];
type Device = keyof typeof REACH_PX;

/** What lies under the finger: a spot, or the handle before spot `k`. */
export type Hit = { readonly what: 'spot' | 'handle'; readonly k: number };

/** A drag under way. */
export interface Drag extends Hit {
  readonly to: PlanePoint;
}

export interface EditPort {
  readonly drawn: () => DrawnPlan;
  readonly pixel_of: (at: PlanePoint) => Pixel;
  readonly events: () => MapEvents;
  /** Show the drag; null: it ended. */
  readonly show: (drag: Drag | null) => void;
}

const device_of = (event: MapBrowserEvent): Device => {
  const original = event.originalEvent;
  return original instanceof PointerEvent && original.pointerType === 'mouse' ? 'mouse' : 'touch';
};

const pixel_of_event = (event: MapBrowserEvent): Pixel => [
  event.pixel[0] ?? 0,
  event.pixel[1] ?? 0,
];

const nearest = (
  count: number,
  reach_px: number,
  from: Pixel,
  place: (k: number) => Pixel | null,
): number | null => {
  let best: number | null = null;
  let best_px = reach_px;
  for (let k = 0; k < count; k += 1) {
    const pixel = place(k);
    if (!pixel) continue;
    const distance = Math.hypot(pixel[0] - from[0], pixel[1] - from[1]);
    if (distance <= best_px) {
      best = k;
      best_px = distance;
    }
  }
  return best;
};

export class EditInteraction extends PointerInteraction {
  readonly #port: EditPort;
  #mode: MapMode = 'watch';
  #hit: Hit | null = null;
  #pressed: Pixel = [0, 0];
  #drag: Drag | null = null;
  /** Where the press began that shows a direction. */
  #from: LatLon | null = null;

  constructor(port: EditPort) {
    super();
    this.#port = port;
  }

  set_mode(mode: MapMode): void {
    this.#mode = mode;
    this.#end();
  }

  /** A tap that was no drag; called by the map for every click. */
  tap(event: MapBrowserEvent): void {
    const hit = this.#find(pixel_of_event(event), device_of(event));
    const events = this.#port.events();
    if (this.#mode === 'point') return; // its end was the last word
    if (hit?.what === 'spot') events.on_select(this.#index_of(hit.k));
    else if (hit) this.#insert(hit.k, this.#middle_before(hit.k));
    else if (this.#mode === 'draw') events.on_add(from_plane(event.coordinate));
    else {
      events.on_select(null);
      if (this.#mode === 'watch') events.on_place(from_plane(event.coordinate));
    }
  }

  /** Whether the pointer is over something that can be taken. */
  over(event: MapBrowserEvent): boolean {
    return this.#find(pixel_of_event(event), 'mouse') !== null;
  }

  override handleDownEvent(event: MapBrowserEvent): boolean {
    if (this.#mode === 'watch' || this.targetPointers.length > 1) return false;
    this.#pressed = pixel_of_event(event);
    if (this.#mode === 'point') {
      this.#from = from_plane(event.coordinate);
      this.#port.events().on_point(this.#from, null);
      return true;
    }
    this.#hit = this.#find(this.#pressed, device_of(event));
    return this.#hit !== null;
  }

  override handleDragEvent(event: MapBrowserEvent): void {
    if (this.#from && this.targetPointers.length > 1) {
      // Two fingers zoom: the first one showed nothing.
      this.#from = null;
      this.#port.events().on_point(null, null);
    }
    if (this.#from) this.#turn(this.#from, event);
    if (!this.#hit) return;
    if (this.targetPointers.length > 1) {
      this.#end();
      return;
    }
    const [x, y] = pixel_of_event(event);
    const moved = Math.hypot(x - this.#pressed[0], y - this.#pressed[1]);
    if (!this.#drag && moved < DRAG_FROM_PX[device_of(event)]) return;
    const to: PlanePoint = [event.coordinate[0] ?? 0, event.coordinate[1] ?? 0];
    this.#drag = { ...this.#hit, to };
    this.#port.show(this.#drag);
  }

  override handleUpEvent(): boolean {
    this.#from = null;
    const drag = this.#drag;
    this.#end();
    if (drag?.what === 'spot') {
      this.#port.events().on_move(this.#index_of(drag.k), from_plane(drag.to));
    } else if (drag) {
      this.#insert(drag.k, drag.to);
    }
    return false;
  }

  #turn(from: LatLon, event: MapBrowserEvent): void {
    const [x, y] = pixel_of_event(event);
    const moved = Math.hypot(x - this.#pressed[0], y - this.#pressed[1]);
    const toward = moved < TURN_FROM_PX ? null : from_plane(event.coordinate);
    this.#port.events().on_point(from, toward);
  }

  #end(): void {
    this.#from = null;
    this.#hit = null;
    if (this.#drag) this.#port.show(null);
    this.#drag = null;
  }

  #insert(k: number, at: PlanePoint): void {
    this.#port.events().on_insert(this.#index_of(k), from_plane(at));
  }

  #index_of(k: number): number {
    return this.#port.drawn().spots[k]?.index ?? 0;
  }

  #spot_pixel(k: number): Pixel {
    const { xs, ys } = this.#port.drawn().line;
    return this.#port.pixel_of([xs[k] ?? 0, ys[k] ?? 0]);
  }

  #middle_before(k: number): PlanePoint {
    const [from, to] = leg(this.#port.drawn().band, k);
    return [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2];
  }

  #find(pixel: Pixel, device: Device): Hit | null {
    const count = this.#port.drawn().spots.length;
    const spot = nearest(count, REACH_PX[device], pixel, (k) => this.#spot_pixel(k));
    if (spot !== null) return { what: 'spot', k: spot };
    if (this.#mode === 'watch') return null;
    const handle = nearest(count, HANDLE_REACH_PX[device], pixel, (k) => {
      if (k === 0) return null;
      const [from, to] = leg(this.#port.drawn().band, k);
      const [x0, y0] = this.#port.pixel_of(from);
      const [x1, y1] = this.#port.pixel_of(to);
      return Math.hypot(x1 - x0, y1 - y0) < HANDLE_FROM_PX ? null : [(x0 + x1) / 2, (y0 + y1) / 2];
    });
    return handle === null ? null : { what: 'handle', k: handle };
  }
}
