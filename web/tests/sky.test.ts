import { describe, expect, it } from 'vitest';

import {
  by_signal,
  handling_lines,
  position_lines,
  satellite_name,
  signal_tone,
  sky_spots,
  sky_summary,
  type Satellite,
} from '../src/model/sky';
import type { Estimator, Learned, Position } from '../src/model/vehicle';

const satellite = (change: Partial<Satellite>): Satellite => ({
  system: 'gps',
  number: 7,
  elevation_deg: 45,
  azimuth_deg: 0,
  cn0_dbhz: 42,
  used: true,
  ...change,
});

describe('the sky plot', () => {
  it('has north up, the zenith in the middle and the horizon at 1', () => {
    const [north, east, zenith] = sky_spots([
      satellite({ azimuth_deg: 0, elevation_deg: 0 }),
      satellite({ azimuth_deg: 90, elevation_deg: 45 }),
      satellite({ azimuth_deg: 123, elevation_deg: 90 }),
    ]);
    expect(north?.x).toBeCloseTo(0);
    expect(north?.y).toBeCloseTo(-1);
    expect(east?.x).toBeCloseTo(0.5);
    expect(east?.y).toBeCloseTo(0);
    expect(zenith?.x).toBeCloseTo(0);
    expect(zenith?.y).toBeCloseTo(0);
  });

  it('leaves out what has no place, or stands below the horizon', () => {
    expect(
      sky_spots([
        satellite({ azimuth_deg: null }),
        satellite({ elevation_deg: null }),
        satellite({ elevation_deg: -3 }),
      ]),
    ).toEqual([]);
  });

  it('gives the stronger one its name where two names would overlap', () => {
    const spots = sky_spots([
      satellite({ number: 1, cn0_dbhz: 30 }),
      satellite({ number: 2, cn0_dbhz: 45, elevation_deg: 47 }),
      satellite({ number: 3, azimuth_deg: 180 }),
    ]);
    const named = spots.filter((spot) => spot.named).map((spot) => spot.satellite.number);
    expect(spots).toHaveLength(3);
    expect(named).toEqual([2, 3]);
  });

  it('names satellites as RINEX does', () => {
    expect(satellite_name(satellite({}))).toBe('G07');
    expect(satellite_name(satellite({ system: 'galileo', number: 11 }))).toBe('E11');
    expect(satellite_name(satellite({ system: 'new', number: 3 }))).toBe('?03');
  });

  it('orders by use and signal, and counts', () => {
    const weak = satellite({ number: 1, cn0_dbhz: 20 });
    const strong = satellite({ number: 2, cn0_dbhz: 48 });
    const unused = satellite({ number: 3, cn0_dbhz: 50, used: false });
    const unheard = satellite({ number: 4, cn0_dbhz: null, used: null });
    const all = [unheard, unused, weak, strong];
    expect(by_signal(all).map(({ number }) => number)).toEqual([2, 1, 3, 4]);
    expect(sky_summary(all)).toBe('2 used, 3 heard, 4 in view');
    expect(sky_summary([])).toBe('No satellite in view');
    expect([48, 35, 20, null].map(signal_tone)).toEqual(['good', 'warn', 'bad', 'none']);
  });
});

describe('what is known of the position', () => {
  const position: Position = {
    lat: 58,
    lon: 26,
    heading_deg: 10,
    speed_mps: 0,
    horizontal_accuracy_m: 0.02,
    heading_accuracy_deg: null,
    ellipse: { major_m: 0.021, minor_m: 0.012, orientation_deg: 31.6 },
    source: 'gnss+odometry',
    age_s: 0,
    stale: false,
  };
  const estimator: Estimator = {
    alignment: 'aligned',
    advice: null,
    gyro_bias_dps: 0.301,
    compass_bias_deg: -19.96,
    odometry_scale: 0.92,
    side_slip: -0.0462,
    rejected: { position: 3, heading: 0 },
    resets: 1,
  };

  it('is told with what is unknown left unknown', () => {
    expect(position_lines(position, estimator)).toEqual([
      ['Position, 1σ', '2.1 cm along 32°, 1.2 cm across'],
      ['Heading, 1σ', '—'],
      ['From', 'gnss+odometry'],
      ['Compass is off by', '−20.0°'],
      ['Gyro is off by', '0.301 °/s'],
      ['Odometry, true over told', '0.920'],
      ['Drives aside by', '5 cm a metre, to the right'],
      ['Refused', 'position 3'],
      ['Set anew', '1 time'],
    ]);
    expect(position_lines({ ...position, ellipse: null }, undefined)[0]).toEqual([
      'Position, 1σ',
      '2.0 cm',
    ]);
  });
});

describe('how the vehicle answers', () => {
  const set: Learned = {
    delay_s: null,
    delay_set_s: 0.15,
    delay_used_s: 0.15,
    braking_mps2: null,
    braking_set_mps2: 0.6,
    braking_used_mps2: 0.6,
    braking_proved: true,
  };

  it('is as it was set while nothing else is known', () => {
    expect(handling_lines(set)).toEqual([
      ['Answers after', '0.15 s (as set)'],
      ['Brakes with', '0.60 m/s² (as set)'],
    ]);
    expect(handling_lines(undefined)).toEqual([]);
  });

  it('tells what was learned beside what was set', () => {
    const learned: Learned = {
      ...set,
      delay_s: 0.312,
      delay_used_s: 0.312,
      braking_mps2: 0.43,
      braking_used_mps2: 0.396,
    };
    expect(handling_lines(learned)).toEqual([
      ['Answers after', '0.31 s (learned; set 0.15 s)'],
      ['Brakes with', '0.40 m/s² (learned; set 0.60 m/s²)'],
    ]);
  });

  it('says that the brakes were not seen yet', () => {
    expect(handling_lines({ ...set, braking_proved: false })[1]).toEqual([
      'Brakes with',
      '0.60 m/s² (as set, not seen yet)',
    ]);
  });
});
