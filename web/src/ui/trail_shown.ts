// The colours of the way so far: for whoever drives. While something is planned it is one line among others.

import { trail_shades, type TrailShades } from '../model/trail_shades';
import { device } from './device.svelte';
import type { Station } from './station.svelte';

/** Null: in one colour. */
export const trail_shown = ({ tab, live }: Station): TrailShades | null =>
  tab === 'drive'
    ? trail_shades(device.settings.trail, live.capabilities?.limits.max_speed_mps ?? null)
    : null;
