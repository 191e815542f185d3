// The sky as the receivers see it, and how sure the robot is of where it is.

import { fixed } from './figures';
import { count, degrees_text, metres, number_text } from './format';
import { robot_says } from './robot_words';
import { say } from './say';
import type { Estimator, Learned, Position } from './vehicle';

export interface Satellite {
  readonly system: string;
  /** Within its system. */
  readonly number: number;
  readonly elevation_deg: number | null;
  readonly azimuth_deg: number | null;
  /** Null: in view, but not tracked. */
  readonly cn0_dbhz: number | null;
  readonly used: boolean | null;
}
export interface ReceiverSky {
  readonly driver: string;
  readonly age_s: number | null;
  readonly stale: boolean;
  readonly satellites: readonly Satellite[];
}

const LETTERS: Readonly<Record<string, string>> = {
  gps: 'G',
  glonass: 'R',
  galileo: 'E',
  beidou: 'C',
  qzss: 'J',
  sbas: 'S',
  navic: 'I',
};

/** As in RINEX: "G07", "E11". */
export const satellite_name = ({ system, number }: Satellite): string =>
  `${LETTERS[system] ?? '?'}${String(number).padStart(2, '0')}`;

/** Good enough for RTK from 40 dB-Hz on; below 30 hardly of use. */
export const signal_tone = (cn0_dbhz: number | null): 'good' | 'warn' | 'bad' | 'none' => {
  if (cn0_dbhz === null) return 'none';
  if (cn0_dbhz >= 40) return 'good';
  return cn0_dbhz >= 30 ? 'warn' : 'bad';
};

export interface SkySpot {
  readonly satellite: Satellite;
  /** Right and down from the zenith, where 1 is the horizon. */
  readonly x: number;
  readonly y: number;
  /** There is room for its name. */
  readonly named: boolean;
}

/** Half of what a name takes in the plot, across and down. */
const NAME_ROOM = { x: 0.27, y: 0.17 };

/** Where each one stands in a plot with north up, the strongest first: they get a name where names
 * would overlap. Those of unknown place are left out. */
export const sky_spots = (satellites: readonly Satellite[]): readonly SkySpot[] => {
  const spots: SkySpot[] = [];
  for (const satellite of by_signal(satellites)) {
    const { elevation_deg, azimuth_deg } = satellite;
    if (elevation_deg === null || azimuth_deg === null || elevation_deg < 0) continue;
    const out = 1 - Math.min(elevation_deg, 90) / 90;
    const turn = (azimuth_deg * Math.PI) / 180;
    const [x, y] = [out * Math.sin(turn), -out * Math.cos(turn)];
    const crowded = spots.some(
      (other) =>
        other.named && Math.abs(other.x - x) < NAME_ROOM.x && Math.abs(other.y - y) < NAME_ROOM.y,
    );
    spots.push({ satellite, x, y, named: !crowded });
  }
  return spots;
};

/** Used ones first, then by the strength of the signal. */
export const by_signal = (satellites: readonly Satellite[]): readonly Satellite[] =>
  [...satellites].sort(
    (a, b) =>
      Number(b.used ?? false) - Number(a.used ?? false) || (b.cn0_dbhz ?? -1) - (a.cn0_dbhz ?? -1),
  );

export const sky_summary = (satellites: readonly Satellite[]): string => {
  const tracked = satellites.filter(({ cn0_dbhz }) => cn0_dbhz !== null);
  const used = satellites.filter((each) => each.used === true);
  if (satellites.length === 0) return say('no_satellite_in_view');
  return say('used_used_tracked_heard_satellites', {
    used: used.length,
    tracked: tracked.length,
    satellites: satellites.length,
  });
};

/** In centimetres for a metre of way: it is steered against. */
const side_slip_text = (share: number | null): string => {
  if (share === null) return '—';
  const cm = Math.round(Math.abs(share) * 100);
  return cm === 0 ? say('word_nothing') : say(share > 0 ? 'slip_to_left' : 'slip_to_right', { cm });
};

/** How the vehicle answers: what is used, and what was set where that is something else. */
export const handling_lines = (
  learned: Learned | undefined,
): readonly (readonly [string, string])[] => {
  if (!learned) return [];
  const delay = number_text(learned.delay_used_s, 2, 's');
  const delay_why =
    learned.delay_s === null
      ? say('as_set')
      : say('learned_set_delay_set_s', { delay_set: fixed(learned.delay_set_s, 2) });
  const braking = number_text(learned.braking_used_mps2, 2, 'm/s²');
  const as_set = learned.braking_used_mps2 >= learned.braking_set_mps2 - 0.005;
  const set = say('learned_set_braking_set_m_s', {
    braking_set: fixed(learned.braking_set_mps2, 2),
  });
  const braking_why =
    (as_set ? say('as_set') : set) + (learned.braking_proved ? '' : say('not_seen_yet'));
  return [
    [say('answers_after'), `${delay} (${delay_why})`],
    [say('brakes_with'), `${braking} (${braking_why})`],
  ];
};

/** What the robot knows of its place and heading, as pairs of name and value. */
export const position_lines = (
  position: Position,
  estimator: Estimator | undefined,
): readonly (readonly [string, string])[] => {
  const { ellipse } = position;
  const out: [string, string][] = [
    [
      say('position_1'),
      ellipse
        ? say('major_along_orientation_deg', {
            major: metres(ellipse.major_m),
            orientation: Math.round(ellipse.orientation_deg),
          }) + say('minor_across', { minor: metres(ellipse.minor_m) })
        : metres(position.horizontal_accuracy_m),
    ],
    [say('heading_1'), degrees_text(position.heading_accuracy_deg)],
    [say('from'), robot_says(position.source ?? '—')],
  ];
  if (!estimator) return out;
  out.push([say('compass_is_off_by'), degrees_text(estimator.compass_bias_deg)]);
  if (estimator.gyro_bias_dps !== null) {
    out.push([say('gyro_is_off_by'), number_text(estimator.gyro_bias_dps, 3, '°/s')]);
  }
  out.push([say('odometry_true_over_told'), number_text(estimator.odometry_scale, 3)]);
  out.push([say('drives_aside_by'), side_slip_text(estimator.side_slip)]);
  const refused = Object.entries(estimator.rejected)
    .filter(([, times]) => times > 0)
    .map(([what, times]) => `${what} ${times}`);
  out.push([say('refused'), refused.length === 0 ? say('nothing_refused') : refused.join(', ')]);
  out.push([say('set_anew'), count(estimator.resets, 'time')]);
  return out;
};
