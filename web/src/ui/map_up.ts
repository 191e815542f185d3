// Which way is up on this device's map.

import { device } from './device.svelte';
import type { Station } from './station.svelte';

export const toggle_map_up = (station: Station): void => {
  if (station.tab !== 'drive') return;
  const turns = device.settings.map_up === 'north';
  device.choose({ map_up: turns ? 'heading' : 'north' });
  if (turns) station.set_follow(true); // else nothing would be seen of it
};
