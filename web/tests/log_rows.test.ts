import { describe, expect, it } from 'vitest';

import { log_rows } from '../src/model/log_rows';
import type { StationEvent } from '../src/model/vehicle';

const event = (second: number, kind: string, detail: string): StationEvent => ({
  time: `2026-11-28T10:00:${String(second).padStart(2, '0')}Z`,
  level: 'warning',
  kind,
  detail,
});

describe('the rows of the log', () => {
  it('tell what comes and goes once, by its newest, with how often', () => {
    const flaps = [9, 8, 7, 6, 5, 4].map((second) =>
      second % 2 === 0
        ? event(second, 'obstacle_gone', 'the way is clear')
        : event(second, 'obstacle', `something stands in the way, 0.${second} m ahead`),
    );
    expect(
      log_rows(flaps).map(({ event: { kind, detail }, times }) => [kind, detail, times]),
    ).toEqual([
      ['obstacle', 'something stands in the way, 0.9 m ahead', 3],
      ['obstacle_gone', 'the way is clear', 3],
    ]);
  });

  it('keep apart what differs by more than its figures, and what lies far back', () => {
    expect(
      log_rows([event(3, 'known_place', 'gate fits'), event(2, 'known_place', 'door fits')]),
    ).toHaveLength(2);
    for (const [kind, one, other] of [
      ['item_missed', 'item 3 was missed by 0.4 m', 'item 7 was missed by 0.4 m'],
      ['safety_parameter', 'max_mps from 0.8 m/s to 1.2 m/s', 'max_mps from 1.2 m/s to 1.5 m/s'],
      ['driver_down', 'lidar1: silent', 'lidar2: silent'],
      ['mission_started', 'Field 1', 'Field 2'],
    ] as const)
      expect(log_rows([event(3, kind, one), event(2, kind, other)])).toHaveLength(2);
    const between = ['armed', 'mission_started', 'disarmed'].map((kind) => event(4, kind, ''));
    const rows = log_rows([event(9, 'obstacle', 'x'), ...between, event(1, 'obstacle', 'x')]);
    expect(rows.map(({ times }) => times)).toEqual([1, 1, 1, 1, 1]);
    expect(log_rows([])).toEqual([]);
  });
});
