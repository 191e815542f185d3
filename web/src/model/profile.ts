// The vehicle's profile as it is in force, in words.

import { metres, number_text } from './format';
import { say } from './say';
import { speed_text, type SpeedUnit } from './settings';
import type { Capabilities } from './vehicle';

export type ProfileLine = readonly [name: string, value: string];

export const profile_lines = (
  { title, vehicle, kinematics, size, limits, guard, drivers, modes }: Capabilities,
  unit: SpeedUnit,
): ProfileLine[] => {
  const lines: ProfileLine[] = [
    [say('profile_name'), `${title} (${vehicle})`],
    [say('profile_steers'), kinematics.replaceAll('_', ' ')],
    [say('profile_size'), `${metres(size.length_m)} × ${metres(size.width_m)}`],
    [say('profile_mass'), number_text(size.mass_kg, 0, 'kg')],
    [say('profile_fastest'), speed_text(limits.max_speed_mps, unit)],
    [say('profile_turns'), number_text(limits.max_yaw_rate_dps, 0, '°/s')],
    [say('profile_accelerates'), number_text(limits.max_acceleration_mps2, 2, 'm/s²')],
    [say('profile_pivots'), number_text(limits.pivot_angle_deg, 0, '°')],
  ];
  if (guard) {
    lines.push(
      [say('profile_gap'), metres(guard.gap_m)],
      [say('profile_side'), metres(guard.side_m)],
      [say('brakes_with'), number_text(guard.decel_mps2, 2, 'm/s²')],
    );
  }
  lines.push(
    [say('profile_modes'), modes.join(', ')],
    [say('profile_drivers'), drivers.length > 0 ? drivers.join(', ') : say('none')],
  );
  return lines;
};

const POSITION = /^(.+)_(up|middle|down)$/;

/** "SWC up" and what it does; switches that do nothing are left out. */
export const radio_lines = ({ radio }: Capabilities): ProfileLine[] =>
  Object.entries(radio)
    .filter(([, does]) => does !== 'none' && does !== '')
    .map(([position, does]) => {
      const [, name = position, where = ''] = POSITION.exec(position) ?? [];
      return [`${name.toUpperCase()} ${where}`.trim(), does.replaceAll('_', ' ')];
    });
