// Keeps the map in step with the places that are kept: where it slipped, and what it knows itself by.

import { untrack } from 'svelte';

import type { Station } from './station.svelte';

/** Called where effects may begin. */
export const keep_places_in_step = (station: Station): void => {
  const { known, map, slips } = station;
  $effect(() =>
    map.show_places({
      slips: slips.on_map,
      known: known.on_map,
      graph: station.tab === 'plan' && station.drawing === null ? station.graph_on_map : null,
    }),
  );
  // As long as somebody sees them: in the log, or on the map.
  const slips_seen = $derived(slips.shown || station.tab === 'log');
  $effect(() => (slips_seen ? untrack(() => slips.watch()) : undefined));
};
