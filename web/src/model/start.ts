// Where a start begins and what speaks for and against it, in words and lights.

import { robot_says } from './robot_words';
import { accuracy, count, degrees_text, direction, metres } from './format';
import { target_words, type WayHome } from './homeward';
import type { CheckReport } from './ports';
import { say } from './say';
import { HEADING_DEG } from './sureness';
import {
  fix_words,
  type Lead,
  type FenceState,
  type Preview,
  type SmoothedItems,
  type Vehicle,
} from './vehicle';

/** Empty: it drives to its first item, which is said anyway. */
export const beginning_words = (preview: Preview): string => {
  const { joins_after_m, left_out } = preview;
  if (joins_after_m === null) return '';
  const where =
    joins_after_m < 0.05
      ? say('the_robot_stands_at_the_beginning_of')
      : say('the_robot_joins_its_way_where_it', { joins_after: metres(joins_after_m) });
  if (left_out === 0) return where;
  return say('items_left_out', { where, n: left_out });
};

/** What is asked of the driving while the position is as certain as it is; empty: nothing is driven. */
export const tolerance_words = (mission: Vehicle['mission']): string => {
  const { arrival_radius_m, cross_track_limit_m } = mission;
  if (arrival_radius_m === null || cross_track_limit_m === null) return '';
  return say('counts_as_reached_within_arrival', {
    arrival_radius: metres(arrival_radius_m),
    cross_track_limit: metres(cross_track_limit_m),
  });
};

/** What an item by sight is driven by right now, and who tells it. */
export const lead_words = ({ what, source }: Lead): string => {
  const leads = {
    row: 'lead_row',
    wall: 'lead_wall',
    landmarks: 'lead_landmarks',
    tag: 'lead_tag',
  } as const;
  const words = say(leads[what]);
  return source === null
    ? say('lead_unseen', { what: words })
    : say('lead_by', { what: words, by: say(`seen_by_${source}`) });
};

/** How far the way is from its items. @param stretches the farthest first. Empty: it meets them. */
export const smoothed_words = (stretches: readonly SmoothedItems[]): string => {
  const [farthest] = stretches;
  if (!farthest) return '';
  const where =
    stretches.length === 1
      ? say('items_first_item_to_last_item_are', {
          first_item: farthest.first_item,
          last_item: farthest.last_item,
        })
      : say('stretches_stretches_of_dense_points', { stretches: stretches.length });
  return say('where_driven_as_a_smooth_way_at_most', {
    where,
    deviation: metres(farthest.deviation_m),
  });
};

export interface StartLight {
  readonly light: 'good' | 'warn' | 'bad';
  readonly subject: string;
  readonly words: string;
}
/** Good enough for rows. */
const FINE_M = 0.1;
/** Farther away than this its first way is worth a look. */
const FAR_M = 20;

const way_light = ({ distance_m, bearing_deg, joins_after_m }: Preview): StartLight => {
  const subject = joins_after_m === null ? say('to_its_first_item') : say('to_its_way');
  if (distance_m === null) return { light: 'warn', subject, words: say('not_known_2') };
  const words = `${metres(distance_m)}, ${direction(bearing_deg)}`;
  return { light: distance_m > FAR_M ? 'warn' : 'good', subject, words };
};

const fence_light = (fence: FenceState | null): StartLight => {
  const subject = say('fence');
  if (fence === null) return { light: 'warn', subject, words: say('none_holds') };
  const limit = metres(fence.distance_m === null ? null : Math.abs(fence.distance_m));
  return fence.inside
    ? {
        light: 'good',
        subject,
        words: say('inside_name_limit_from_its_limit', { name: fence.name, limit }),
      }
    : {
        light: 'bad',
        subject,
        words: say('outside_of_name_by_limit', { name: fence.name, limit }),
      };
};

const home_light = (home: WayHome | null): StartLight => {
  const subject = say('way_home');
  if (home === null) return { light: 'warn', subject, words: say('not_known_yet') };
  if (!home.possible) return { light: 'warn', subject, words: robot_says(home.reason) };
  return { light: 'good', subject, words: `${target_words(home)}, ${metres(home.distance_m)}` };
};

const check_light = (report: CheckReport | null, failure: string | null): StartLight => {
  const subject = say('check');
  if (report === null) return { light: 'warn', subject, words: failure ?? say('asks_the_robot') };
  const errors = report.findings.filter(({ severity }) => severity === 'error').length;
  const warnings = report.findings.length - errors;
  if (errors > 0) return { light: 'bad', subject, words: count(errors, 'error') };
  if (warnings > 0) return { light: 'warn', subject, words: count(warnings, 'warning') };
  return { light: 'good', subject, words: say('nothing_speaks_against_it') };
};

const position_light = ({ position, gnss }: Vehicle): StartLight => {
  const accuracy_m = position.horizontal_accuracy_m;
  const words = `${fix_words[gnss.fix]}, ${accuracy(accuracy_m)}`;
  const light = accuracy_m === null ? 'bad' : accuracy_m > FINE_M ? 'warn' : 'good';
  return { light: position.stale ? 'bad' : light, subject: say('position'), words };
};

const heading_light = ({ position }: Vehicle): StartLight => {
  const subject = say('heading');
  const { heading_accuracy_deg: off_deg } = position;
  if (off_deg === null) return { light: 'bad', subject, words: say('not_known_2') };
  const light = position.stale ? 'bad' : off_deg > HEADING_DEG.good ? 'warn' : 'good';
  return { light, subject, words: `±${degrees_text(off_deg)}` };
};

export interface StartFacts {
  readonly vehicle: Vehicle;
  readonly preview: Preview;
  readonly home: WayHome | null;
  readonly report: CheckReport | null;
  /** Why there is no report. */
  readonly failure: string | null;
}

const URGENCY: readonly StartLight['light'][] = ['bad', 'warn', 'good'];

/** What is to be seen before it moves: what speaks against it first, for a small screen shows but some
 * lines; among equals always in the same order. */
export const start_lights = (facts: StartFacts): readonly StartLight[] =>
  [
    way_light(facts.preview),
    check_light(facts.report, facts.failure),
    fence_light(facts.vehicle.fence),
    home_light(facts.home),
    position_light(facts.vehicle),
    heading_light(facts.vehicle),
  ].sort((a, b) => URGENCY.indexOf(a.light) - URGENCY.indexOf(b.light));
