import { describe, expect, test } from 'vitest';

import { deck_figures } from '../src/model/deck';
import type { Vehicle } from '../src/model/vehicle';

/** On the way, 3.4 cm left of its path; it pauses 3 m off. */
const vehicle = (given: object = {}, speed_mps: number | null = 0.8): Vehicle =>
  ({
    position: { speed_mps },
    mission: {
      cross_track_m: 0.034,
      cross_track_limit_m: 3,
      distance_left_m: 51.27,
      eta_s: 89.6,
      ...given,
    },
  }) as unknown as Vehicle;

const said = (of: Vehicle | null): string[] =>
  deck_figures(of).map(({ label, value, unit, side }) =>
    `${label}: ${value} ${unit} ${side?.word ?? ''}`.trim(),
  );

describe('the figures of the deck', () => {
  test('are a number and what it is a number of', () => {
    expect(said(vehicle())).toEqual([
      'Speed: 0.80 m/s',
      'Off path: 3.4 cm left',
      'To drive: 51.3 m',
      'Time left: 1:30 min',
    ]);
    expect(
      said(vehicle({ cross_track_m: -0.25, distance_left_m: 1234, eta_s: 4330 }, -0.3)),
    ).toEqual([
      'Speed: −0.30 m/s',
      'Off path: 0.25 m right',
      'To drive: 1.23 km',
      'Time left: 1:12 h',
    ]);
    expect(said(vehicle({ eta_s: 9.4 }))[3]).toBe('Time left: 9 s');
    expect(said(vehicle({ eta_s: 59.7 }))[3]).toBe('Time left: 1:00 min');
    expect(said(vehicle({ cross_track_m: 0 }))[1]).toBe('Off path: 0.0 cm');
  });

  test('tell nothing that is left of a mission that has ended, and no time of one that is blocked', () => {
    for (const state of ['aborted', 'finished'])
      expect(said(vehicle({ state })).slice(2)).toEqual(['To drive: —', 'Time left: —']);
    const blocked = { ...vehicle({ state: 'running' }), obstacle: { blocked: true } } as Vehicle;
    expect(said(blocked).slice(2)).toEqual(['To drive: 51.3 m', 'Time left: —']);
  });

  test('tell the side by an arrow: beside the unit there is no room for a word', () => {
    const side = (off_m: number | null) => deck_figures(vehicle({ cross_track_m: off_m }))[1]?.side;
    expect(side(0.034)?.arrow).toBe('◂');
    expect(side(-0.25)?.arrow).toBe('▸');
    expect(side(0)).toBeNull();
    expect(side(null)).toBeNull();
  });

  test('tell the speed in the unit that was chosen', () => {
    expect(deck_figures(vehicle(), 'km/h')[0]).toMatchObject({ value: '2.9', unit: 'km/h' });
  });

  test('stay four, each a dash, while nothing is known', () => {
    const nothing = ['Speed: —', 'Off path: —', 'To drive: —', 'Time left: —'];
    expect(said(null)).toEqual(nothing);
    const unknown = { cross_track_m: null, distance_left_m: null, eta_s: null };
    expect(said(vehicle(unknown, null))).toEqual(nothing);
  });

  test('warn from half of the limit at which the mission pauses', () => {
    const tone = (
      cross_track_m: number,
      cross_track_limit_m: number | null = 3,
    ): string | undefined => deck_figures(vehicle({ cross_track_m, cross_track_limit_m }))[1]?.tone;
    expect(tone(1.49)).toBe('plain');
    expect(tone(-1.5)).toBe('warn');
    expect(tone(3)).toBe('bad');
    expect(tone(9, null)).toBe('plain');
  });
});
