// What a drill found: where the robot would stand if something failed. In words a person can read
// before the robot is sent off.

import { metres, number_text } from './format';
import type { LatLon } from './plan';
import { say } from './say';
import { speed_text, type SpeedUnit } from './settings';

export interface DrillFailure {
  readonly id: string;
  readonly title: string;
}
export type DrillEnd = 'stands' | 'finished' | 'home' | 'goes_on' | 'not_played';
export interface DrillPose extends LatLon {
  readonly heading_deg: number;
}
/** Of a failure that was not played only the first four. */
export interface DrillResult {
  readonly failure: string;
  readonly title: string;
  readonly end: DrillEnd;
  readonly reason: string;
  readonly zero_s?: number | null;
  readonly stands_s?: number | null;
  readonly way_m?: number;
  readonly speed_mps?: number;
  readonly begins?: DrillPose;
  readonly last?: DrillPose;
  readonly off_way_m?: number | null;
  readonly fence_distance_m?: number | null;
  readonly inside_fence?: boolean | null;
  readonly mode?: string | null;
  readonly armed?: boolean | null;
  readonly estop?: boolean | null;
  readonly said?: readonly { readonly id: string; readonly detail: string }[];
  readonly track?: readonly LatLon[];
}
export interface Drill {
  readonly id: number;
  readonly state: 'none' | 'running' | 'done' | 'failed' | 'cancelled';
  readonly mission: {
    readonly id: string;
    readonly revision: number;
    readonly name: string;
  } | null;
  readonly fence_id: string | null;
  readonly begins: {
    readonly at_m: number;
    readonly length_m: number;
    readonly speed_mps: number;
    readonly lat: number;
    readonly lon: number;
    readonly failures: readonly string[];
  } | null;
  readonly results: readonly DrillResult[];
  readonly detail: string | null;
  readonly failures: readonly DrillFailure[];
}
export interface DrillWish {
  /** Left out: what is loaded. */
  readonly mission?: { readonly id: string; readonly revision: number };
  /** Left out: the middle. */
  readonly at_m?: number;
  /** Left out: all that the vehicle has. */
  readonly failures?: readonly string[];
}

/** How a result is looked at: it stands; it drives on, as it was told to; it leaves the fence. */
export type DrillTone = 'stands' | 'on' | 'bad' | 'none';

export const drill_tone = ({ end, inside_fence }: DrillResult): DrillTone => {
  if (end === 'not_played') return 'none';
  if (inside_fence === false) return 'bad';
  return end === 'stands' ? 'stands' : 'on';
};

const seconds = (value: number | null | undefined): string => number_text(value, 1, 's');

/** "stands after 1.4 s, 1.01 m" */
export const drill_outcome = (result: DrillResult): string => {
  const outside = result.inside_fence === false ? say('outside_the_fence') : '';
  switch (result.end) {
    case 'stands':
      return say('stands_after_stands_way_outside', {
        stands: seconds(result.stands_s),
        way: metres(result.way_m),
        outside,
      });
    case 'home':
      return say('returns_home_way_outside', { way: metres(result.way_m), outside });
    case 'finished':
      return say('drives_on_to_the_mission_s_end_outside', { outside });
    case 'goes_on':
      return say('still_drives_after_way_outside', { way: metres(result.way_m), outside });
    case 'not_played':
      return say('not_played');
  }
};

export interface DrillRow {
  readonly label: string;
  readonly value: string;
}

const afterwards = ({ mode, armed, estop }: DrillResult): string => {
  if (mode === null || mode === undefined) return say('no_program');
  return `${mode}, ${armed === true ? say('word_armed') : say('word_disarmed')}${estop === true ? say('stop_latched') : ''}`;
};

/** What else is known of one failure. */
export const drill_rows = (result: DrillResult, speed: SpeedUnit = 'm/s'): DrillRow[] => {
  if (result.end === 'not_played') return [];
  const rows: DrillRow[] = [
    { label: say('speed_before'), value: speed_text(result.speed_mps, speed) },
    { label: say('command_zero_after'), value: seconds(result.zero_s) },
    { label: say('stands_after'), value: seconds(result.stands_s) },
    { label: say('driven'), value: metres(result.way_m) },
    { label: say('off_the_way'), value: metres(result.off_way_m) },
    { label: say('afterwards'), value: afterwards(result) },
  ];
  const fence_m = result.fence_distance_m;
  if (typeof fence_m === 'number') {
    const value = fence_m > 0 ? metres(fence_m) : say('fence_outside', { fence: metres(-fence_m) });
    rows.splice(5, 0, { label: say('nearest_to_the_fence'), value });
  }
  return rows;
};

/** The longest way among those that end standing: the figure to keep in mind. */
export const drill_summary = (drill: Drill): string => {
  const played = drill.results.filter(({ end }) => end !== 'not_played');
  const standing = played.filter(({ end }) => end === 'stands');
  const outside = played.filter(({ inside_fence }) => inside_fence === false).length;
  const worst = Math.max(...standing.map(({ way_m }) => way_m ?? 0));
  const parts = [
    say('standing_of_played_stand', { standing: standing.length, played: played.length }),
  ];
  if (standing.length > 0) parts.push(say('after_worst_at_most', { worst: metres(worst) }));
  if (drill.fence_id !== null) {
    parts.push(
      outside === 0 ? say('all_inside_the_fence') : say('outside_outside_the_fence', { outside }),
    );
  }
  return `${parts.join(', ')}.`;
};

/** Where the robot would stand after a failure, or be at the end of the simulated time. */
export interface DrilledPlace extends LatLon {
  readonly heading_deg: number;
  /** The way there from the failure. */
  readonly line: readonly LatLon[];
  readonly tone: DrillTone;
  readonly label: string;
  /** It is looked at. */
  readonly chosen: boolean;
}
export interface DrillOnMap {
  readonly begins: LatLon | null;
  readonly places: readonly DrilledPlace[];
}

/** @param chosen the failure that is looked at; null: all alike */
export const drill_on_map = (drill: Drill, chosen: string | null): DrillOnMap => ({
  begins: drill.begins && { lat: drill.begins.lat, lon: drill.begins.lon },
  places: drill.results.flatMap((result) =>
    result.last && result.end !== 'not_played'
      ? [
          {
            lat: result.last.lat,
            lon: result.last.lon,
            heading_deg: result.last.heading_deg,
            line: result.track ?? [],
            tone: drill_tone(result),
            label: result.title,
            chosen: result.failure === chosen,
          },
        ]
      : [],
  ),
});

/** What the map should show: where it stands, not how far those drive that go on. */
export const drill_places = (drill: Drill, chosen: string | null): readonly LatLon[] => {
  const one = drill.results.find(({ failure }) => failure === chosen);
  if (one) return [...(one.track ?? []), ...(one.last ? [one.last] : [])];
  const standing = drill.results.flatMap(({ end, last }) =>
    end === 'stands' && last ? [last] : [],
  );
  return [...(drill.begins ? [drill.begins] : []), ...standing];
};
