import { describe, expect, it } from 'vitest';

import { profile_lines, radio_lines } from '../src/model/profile';
import type { Capabilities } from '../src/model/capabilities';

const BUNKER: Capabilities = {
  version: '0.1.0',
  vehicle: 'bunker',
  title: 'AgileX Bunker',
  kinematics: 'skid_steer',
  size: { length_m: 1.02, width_m: 0.76, mass_kg: 145 },
  limits: {
    max_speed_mps: 1.3,
    max_yaw_rate_dps: 90,
    max_acceleration_mps2: 0.5,
    pivot_angle_deg: 60,
  },
  guard: null,
  modes: ['HOLD', 'MANUAL'],
  drivers: ['bunker', 'gnss'],
  radio: { swc_up: 'mode.manual', swc_middle: 'none', vra: 'by_knob', swd_down: '' },
  item_types: [],
  import_formats: [],
  export_formats: [],
};

describe("the vehicle's profile", () => {
  it('says what it is and how fast, in the unit of this device', () => {
    const lines = new Map(profile_lines(BUNKER, 'km/h'));
    expect(lines.get('Vehicle')).toBe('AgileX Bunker (bunker)');
    expect(lines.get('Steers by')).toBe('skid steer');
    expect(lines.get('Length × width')).toBe('1.02 m × 0.76 m');
    expect(lines.get('Fastest')).toBe('4.7 km/h');
    expect(lines.get('Drivers')).toBe('bunker, gnss');
    expect(lines.has('Stops before things')).toBe(false);
  });

  it('says how near it lets things come where it has sensors, and that it has no driver', () => {
    const guard = {
      back_m: 0.5,
      side_m: 0.2,
      gap_m: 0.4,
      delay_s: 0.3,
      decel_mps2: 0.8,
      turn_decel_dps2: 90,
    };
    const lines = new Map(profile_lines({ ...BUNKER, guard, drivers: [] }, 'm/s'));
    expect(lines.get('Stops before things')).toBe('0.40 m');
    expect(lines.get('Fastest')).toBe('1.30 m/s');
    expect(lines.get('Drivers')).toBe('None');
  });

  it('lists the positions of the switches that do something', () => {
    expect(radio_lines(BUNKER)).toEqual([
      ['SWC up', 'mode.manual'],
      ['VRA', 'by knob'],
    ]);
    expect(radio_lines({ ...BUNKER, radio: {} })).toEqual([]);
  });
});
