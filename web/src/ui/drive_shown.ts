// How the loaded mission is to be driven, on the map: for whoever drives.

import {
  leg_speeds,
  pivots_of,
  speed_tags,
  told_pivots,
  told_speeds,
  type DriveOnMap,
} from '../model/route_drive';
import { device } from './device.svelte';
import type { Station } from './station.svelte';
import { trail_shown } from './trail_shown';

/** Null: nobody drives, or nothing is loaded. */
export const drive_shown = (station: Station): DriveOnMap | null => {
  const { tab, route, live } = station;
  if (tab !== 'drive' || !route.plan) return null;
  const { capabilities } = live;
  const { pace, stops } = route;
  const told = pace.length > 0;
  const speeds = told
    ? told_speeds(route.plan, route.speeds_set, pace)
    : leg_speeds(route.plan, route.speeds_set);
  const shades = trail_shown(station);
  return {
    speeds,
    tags: speed_tags(speeds, device.settings.speed),
    pivots: told
      ? told_pivots(stops, pace, route.begin_deg)
      : capabilities
        ? pivots_of(route.plan, route.way, {
            kinematics: capabilities.kinematics,
            pivot_angle_deg: capabilities.limits.pivot_angle_deg,
          })
        : [],
    pace,
    shades: shades?.by === 'speed' ? shades : null,
  };
};
