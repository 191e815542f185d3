// The hand on the map. What a press means depends on the mode; exactly one is active:
//
//   watch  a tap on a point selects it; one on free ground marks the place
//   edit   also: dragging a point moves it, dragging the way between two, or its "+", inserts one
//          there; so does a tap
//   draw   also: a tap on free ground adds a waypoint at the end; of the way only its "+" is tapped
//   pick   a tap takes a point to the chosen ones, or from them; dragging from free ground draws a
//          box around more; dragging a chosen one moves all
//   point  a press shows a place, and where it is dragged to a direction
//
// With Shift held edit and draw are pick. Nothing is changed here: a drag shows where the point would
// go, and its end is reported once.

import type MapBrowserEvent from 'ol/MapBrowserEvent';
import PointerInteraction from 'ol/interaction/Pointer';

import type { LatLon } from '../model/plan';
import type { MapEvents, MapMode } from '../model/ports';
import { nearest_leg, nearest_spot, spots_in, type Hit } from './hit';
import { HANDLE_FROM_PX, type DrawnPlan } from './plan_painter';
import { from_plane, type PlanePoint } from './projection';
import type { Snapped } from './snap';

/** A gloved finger needs more room than a mouse. */
const REACH_PX = { mouse: 18, touch: 28 } as const;
const HANDLE_REACH_PX = { mouse: 12, touch: 22 } as const;
const LINE_REACH_PX = { mouse: 7, touch: 16 } as const;
const SNAP_PX = { mouse: 10, touch: 16 } as const;
/** Nearer to where the press began no direction is meant. */
const TURN_FROM_PX = 16;
const DRAG_FROM_PX = { mouse: 3, touch: 9 } as const;

type Pixel = readonly [x: number, y: number];
type Device = keyof typeof REACH_PX;
export type Box = readonly [PlanePoint, PlanePoint];

/** A drag under way. */
export interface Drag {
  readonly what: Hit['what'];
  readonly k: number;
  readonly to: PlanePoint;
  /** It lies on something. */
  readonly held: boolean;
}

export interface EditPort {
  readonly drawn: () => DrawnPlan;
  /** Units of the plane in a pixel. */
  readonly resolution: () => number;
  readonly events: () => MapEvents;
  /** The points hang together: there is a way between them. */
  readonly joined: () => boolean;
  /** Index of the item that is selected, or whether it is among the chosen ones. */
  readonly is_chosen: (index: number) => boolean;
  readonly snap: (to: PlanePoint, skip: number, reach: number) => Snapped;
  /** Show the drag; null: it ended. @param finger pixels of the map; null: a mouse, which hides
   * nothing */
  readonly show: (drag: Drag | null, finger: Pixel | null) => void;
  readonly show_box: (box: Box | null) => void;
}

const device_of = (event: MapBrowserEvent): Device => {
  const original = event.originalEvent;
  return original instanceof PointerEvent && original.pointerType === 'mouse' ? 'mouse' : 'touch';
};

const pixel_of_event = (event: MapBrowserEvent): Pixel => [
  event.pixel[0] ?? 0,
  event.pixel[1] ?? 0,
];

const place_of_event = (event: MapBrowserEvent): PlanePoint => [
  event.coordinate[0] ?? 0,
  event.coordinate[1] ?? 0,
];

/** What is being done with the finger that is down. */
type Press =
  | { readonly what: 'take'; readonly hit: Hit; readonly grab: PlanePoint }
  | { readonly what: 'box'; readonly from: PlanePoint }
  | { readonly what: 'turn'; readonly from: LatLon };

export class EditInteraction extends PointerInteraction {
  readonly #port: EditPort;
  #mode: MapMode = 'watch';
  #press: Press | null = null;
  #pressed: Pixel = [0, 0];
  #drag: Drag | null = null;
  #box: Box | null = null;

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
    const mode = this.#mode_of(event);
    if (mode === 'point') return; // its end was the last word
    const hit = this.#find(place_of_event(event), device_of(event));
    const events = this.#port.events();
    if (mode === 'pick') {
      if (hit?.what === 'spot') events.on_pick(this.#index_of(hit.k));
    } else if (hit?.what === 'spot') events.on_select(this.#index_of(hit.k));
    else if (hit && (hit.middle || mode === 'edit')) this.#insert(hit.k, hit.at);
    else if (mode === 'draw') events.on_add(from_plane(event.coordinate));
    else {
      events.on_select(null);
      if (mode === 'watch') events.on_place(from_plane(event.coordinate));
    }
  }

  /** Whether the pointer is over something that can be taken. */
  over(event: MapBrowserEvent): boolean {
    return this.#find(place_of_event(event), 'mouse') !== null;
  }

  override handleDownEvent(event: MapBrowserEvent): boolean {
    const mode = this.#mode_of(event);
    if (mode === 'watch' || this.targetPointers.length > 1) return false;
    this.#pressed = pixel_of_event(event);
    this.#press = this.#begin(event, mode);
    if (this.#press?.what === 'turn') this.#port.events().on_point(this.#press.from, null);
    return this.#press !== null;
  }

  override handleDragEvent(event: MapBrowserEvent): void {
    const press = this.#press;
    if (!press) return;
    if (this.targetPointers.length > 1) {
      // Two fingers zoom: the first one showed nothing.
      if (press.what === 'turn') this.#port.events().on_point(null, null);
      this.#end();
      return;
    }
    if (press.what === 'turn') {
      this.#turn(press.from, event);
      return;
    }
    const [x, y] = pixel_of_event(event);
    const moved = Math.hypot(x - this.#pressed[0], y - this.#pressed[1]);
    const under_way = this.#drag ?? this.#box;
    if (!under_way && moved < DRAG_FROM_PX[device_of(event)]) return;
    if (press.what === 'box') {
      this.#box = [press.from, place_of_event(event)];
      this.#port.show_box(this.#box);
    } else this.#drag_to(press.hit, press.grab, event);
  }

  override handleUpEvent(): boolean {
    const [drag, box] = [this.#drag, this.#box];
    this.#end();
    if (box) this.#pick_box(box);
    else if (drag?.what === 'spot') {
      this.#port.events().on_move(this.#index_of(drag.k), from_plane(drag.to));
    } else if (drag) this.#insert(drag.k, drag.to);
    return false;
  }

  #mode_of(event: MapBrowserEvent): MapMode {
    const shift = event.originalEvent instanceof MouseEvent && event.originalEvent.shiftKey;
    return shift && (this.#mode === 'edit' || this.#mode === 'draw') ? 'pick' : this.#mode;
  }

  #begin(event: MapBrowserEvent, mode: MapMode): Press | null {
    const from = place_of_event(event);
    if (mode === 'point') return { what: 'turn', from: from_plane(from) };
    const hit = this.#find(from, device_of(event));
    const chosen = hit?.what === 'spot' && this.#port.is_chosen(this.#index_of(hit.k));
    if (mode === 'pick' && !chosen) return { what: 'box', from };
    // Among many points a finger means the map.
    if (!hit || (hit.crowded && !chosen)) return null;
    const grab: PlanePoint = [hit.at[0] - from[0], hit.at[1] - from[1]];
    return { what: 'take', hit, grab: hit.what === 'spot' ? grab : [0, 0] };
  }

  /** A point keeps where it was taken: it does not leap under the finger. */
  #drag_to(hit: Hit, grab: PlanePoint, event: MapBrowserEvent): void {
    const [x, y] = place_of_event(event);
    const device = device_of(event);
    const skip = hit.what === 'spot' ? hit.k : -1;
    const reach = SNAP_PX[device] * this.#port.resolution();
    const to = this.#port.snap([x + grab[0], y + grab[1]], skip, reach);
    this.#drag = { what: hit.what, k: hit.k, ...to };
    this.#port.show(this.#drag, device === 'touch' ? pixel_of_event(event) : null);
  }

  #turn(from: LatLon, event: MapBrowserEvent): void {
    const [x, y] = pixel_of_event(event);
    const moved = Math.hypot(x - this.#pressed[0], y - this.#pressed[1]);
    const toward = moved < TURN_FROM_PX ? null : from_plane(event.coordinate);
    this.#port.events().on_point(from, toward);
  }

  #pick_box(box: Box): void {
    const { line, spots } = this.#port.drawn();
    const found = spots_in(line, spots.length, box).map((k) => this.#index_of(k));
    this.#port.events().on_pick_box(found);
  }

  #end(): void {
    this.#press = null;
    if (this.#drag) this.#port.show(null, null);
    if (this.#box) this.#port.show_box(null);
    this.#drag = null;
    this.#box = null;
  }

  #insert(k: number, at: PlanePoint): void {
    this.#port.events().on_insert(this.#index_of(k), from_plane(at));
  }

  #index_of(k: number): number {
    return this.#port.drawn().spots[k]?.index ?? 0;
  }

  #find(from: PlanePoint, device: Device): Hit | null {
    const { spots, line, band } = this.#port.drawn();
    const pixel = this.#port.resolution();
    const spot = nearest_spot(line, spots.length, from, REACH_PX[device] * pixel);
    if (spot) {
      const at: PlanePoint = [line.xs[spot.k] ?? 0, line.ys[spot.k] ?? 0];
      return { what: 'spot', ...spot, at, middle: false };
    }
    if (this.#mode === 'watch' || this.#mode === 'pick' || !this.#port.joined()) return null;
    return nearest_leg(band, from, {
      line: LINE_REACH_PX[device] * pixel,
      middle: HANDLE_REACH_PX[device] * pixel,
      shortest: HANDLE_FROM_PX * pixel,
    });
  }
}
