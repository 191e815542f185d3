// What a hand on the map changes: the mission, the outline of a field, or a part of a fence.

import { begin_history, perform, undo, type History } from '../model/history';
import {
  add_place,
  insert_place,
  move_place,
  plan_of_places,
  remove_place,
  type Places,
} from '../model/outline';
import type { LatLon, Plan } from '../model/plan';
import type { MapMode, PlanShape } from '../model/ports';

export interface Drawing {
  readonly plan: Plan;
  readonly selected: number | null;
  readonly shape: PlanShape;
  readonly map_mode: MapMode;
  add(at: LatLon): void;
  insert(index: number, at: LatLon): void;
  move(index: number, to: LatLon): void;
  select(index: number | null): void;
  remove_selected(): void;
  undo(): void;
}

/** What a hand on the map does to the places of one ring. */
export abstract class RingDrawing {
  selected = $state<number | null>(null);

  add(at: LatLon): void {
    this.change(add_place(at));
    this.selected = null;
  }

  insert(index: number, at: LatLon): void {
    this.change(insert_place(index, at));
    this.selected = index;
  }

  move(index: number, to: LatLon): void {
    this.change(move_place(index, to));
    this.selected = index;
  }

  select(index: number | null): void {
    this.selected = index;
  }

  remove_selected(): void {
    if (this.selected !== null) this.change(remove_place(this.selected));
    this.selected = null;
  }

  protected abstract change(action: (ring: Places) => Places): void;
}

/** Places with their undo. */
export class Outline extends RingDrawing implements Drawing {
  history = $state.raw<History<Places>>(begin_history<Places>([]));
  places = $derived(this.history.present);
  plan = $derived(plan_of_places(this.places));
  can_undo = $derived(this.history.past.length > 0);
  readonly shape: PlanShape;
  readonly map_mode = 'draw';

  constructor(shape: PlanShape = 'ring') {
    super();
    this.shape = shape;
  }

  undo(): void {
    this.history = undo(this.history);
    this.selected = null;
  }

  clear(): void {
    this.begin([]);
  }

  /** What was drawn elsewhere; there is nothing to undo. */
  begin(places: Places): void {
    this.history = begin_history<Places>(places);
    this.selected = null;
  }

  protected change(action: (ring: Places) => Places): void {
    this.history = perform(this.history, action);
  }
}
