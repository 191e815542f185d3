// The map of the plane that the edited mission counts from: any of the robot's list, wherever the robot is.

import { map_of_plan, type PlanMap } from '../model/map_plan';
import type { LatLon } from '../model/plan';
import { lies_anywhere, place_of_map } from '../model/site_map';
import type { Editor } from './editor.svelte';
import type { SiteMaps } from './site_maps.svelte';

/** A map that lies nowhere has to be drawn somewhere, also where nobody knows a place. */
const ANYWHERE: LatLon = { lat: 0, lon: 0 };

export class MapPlanner {
  /** Null: it counts from none, or from one that is not in the list. */
  by = $derived.by<PlanMap | null>(() => {
    const map = this.#map;
    const at = map && place_of_map(map, this.#here);
    return map && at && { map, at };
  });
  /** The same where it lies somewhere: where another one is drawn means nothing but to who plans in it. */
  laid = $derived.by<PlanMap | null>(() =>
    this.by === null || lies_anywhere(this.by.map) ? null : this.by,
  );
  readonly #editor: Editor;
  readonly #sites: SiteMaps;
  #frame = $derived.by(() => this.#editor.plan.frame ?? null);
  #map = $derived.by(() =>
    map_of_plan({ name: '', items: [], frame: this.#frame }, this.#sites.items),
  );
  /** Where the robot was when it was first asked for: what is drawn does not follow it. */
  #first_here: LatLon | null = null;

  constructor(editor: Editor, sites: SiteMaps) {
    this.#editor = editor;
    this.#sites = sites;
  }

  get #here(): LatLon {
    this.#first_here ??= this.#sites.here;
    return this.#first_here ?? ANYWHERE;
  }
}
