// What a hand on the map changes instead of the mission, by what is open.

import type { Drawing } from './drawing.svelte';
import type { Station } from './station.svelte';

/** Null: the mission. */
export const drawn_in = ({
  tab,
  shelf,
  surveyor,
  rower,
  measurer,
  fences,
  sites,
}: Station): Drawing | null => {
  if (tab === 'plan') {
    if (surveyor.open) return surveyor.outline;
    if (rower.open) return rower.outline;
    return measurer.open ? measurer : null;
  }
  if (tab !== 'missions') return null;
  if (shelf === 'fences') return fences.draft ? fences : null;
  return shelf === 'maps' && sites.editor.map ? sites.editor : null;
};
