// Keeps the map in step with the ground's pictures, and with the maps of places: the one in use, or
// the one that is looked at.

import { untrack } from 'svelte';

import { maps_wanted } from '../model/map_frame';
import type { Station } from './station.svelte';

/** Called where effects may begin. */
export const keep_site_in_step = (station: Station): void => {
  const { live, map } = station;
  // Where there is a map in use; and in the list of maps, which one may be.
  const maps_seen = $derived(station.tab === 'missions' && station.shelf === 'maps');
  const located = $derived((live.vehicle?.place?.state ?? 'off') !== 'off');
  const map_in_use = $derived(live.vehicle?.place?.map_id ?? null);
  const planned = $derived(station.tab === 'plan' ? station.in_map.by : null);
  const site_drawn = $derived(
    maps_seen || planned !== null || (located && station.seen.layers.map),
  );
  // A mission that counts from a map has to be told from which, also where the robot is in none.
  const sites_wanted = $derived(
    maps_wanted(site_drawn, station.tab === 'plan' ? station.editor.plan : null),
  );
  $effect(() => {
    void map_in_use; // another one: whoever changed it
    const draws = site_drawn;
    return sites_wanted ? untrack(() => station.sites.watch(draws)) : undefined;
  });
  $effect(() => {
    const { grounds } = station;
    map.use_ground(grounds.shown, (silent) => (grounds.silent = silent));
  });
  $effect(() => {
    if (maps_seen) void untrack(() => station.grounds.refresh());
  });
  // From which maps a mission could count is asked once.
  $effect(() => {
    if (station.tab === 'plan') void untrack(() => station.sites.refresh());
  });
  $effect(() => {
    const by = planned;
    untrack(() => station.sites.plan_in(by));
  });
  $effect(() => station.sites.look(maps_seen));
  $effect(() => map.show_site(site_drawn ? station.sites.on_map : null));
  $effect(() => map.show_site_edits(maps_seen ? station.sites.editor.edits : []));
};
