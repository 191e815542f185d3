import { describe, expect, test } from 'vitest';

import { Tracks } from '../src/model/tracks';
import { Trail, type TrailPiece } from '../src/model/trail';
import type { Vehicle } from '../src/model/vehicle';

const REACH_M = 10;
const north = (metres: number) => ({ lat: 58 + metres / 111_000, lon: 26 });
const metres = (trail: Trail): number[] =>
  trail.points().map(({ lat }) => Math.round((lat - 58) * 111_000));
/** Where pieces begin. */
const begins = (trail: Trail): number[] => metres(trail).filter((_, k) => trail.begins(k));
const piece = (...places: readonly (readonly [metres: number, t_s: number])[]): TrailPiece =>
  places.map(([at, t_s]) => ({ ...north(at), t_s }));

describe('trail', () => {
  test('keeps points in order and leaves out standing still', () => {
    const trail = new Trail(10, 0.05);
    expect(trail.add(north(0), 1, REACH_M)).toBe(true);
    expect(trail.add(north(0.01), 2, REACH_M)).toBe(false);
    expect(trail.add(north(1), 3, REACH_M)).toBe(true);
    expect(trail.length).toBe(2);
    expect(trail.at(1)).toEqual({ ...north(1), t_s: 3 });
    expect(trail.at(2)).toBeUndefined();
    expect(trail.at(-1)).toBeUndefined();
  });

  test('drops the oldest point when it is full', () => {
    const trail = new Trail(3, 0.05);
    for (let k = 0; k < 5; k += 1) trail.add(north(k), k, REACH_M);
    expect(trail.full).toBe(true);
    expect(metres(trail)).toEqual([2, 3, 4]);
    expect(begins(trail)).toEqual([2]);
    expect(trail.added).toBe(5);
  });

  test('begins a new piece where the position jumps', () => {
    const trail = new Trail(10);
    for (const at of [0, 5, 25, 26, 11, 3]) trail.add(north(at), at, REACH_M);
    expect(begins(trail)).toEqual([0, 25, 11]);
  });

  test('can be cleared, which is news too', () => {
    const trail = new Trail(3);
    trail.add(north(0), 0, REACH_M);
    const seen = trail.added;
    trail.clear();
    expect(trail.length).toBe(0);
    expect(trail.added).toBeGreaterThan(seen);
  });

  test('takes over what the server remembers, piece by piece, instead of its own', () => {
    const trail = new Trail(10);
    for (const k of [4, 5, 6]) trail.add(north(k), k, REACH_M);
    const seen = trail.added;
    trail.restore([piece([0, 0], [1, 1]), piece([3, 3], [5, 5])], 6);
    expect(metres(trail)).toEqual([0, 1, 3, 5]);
    expect(begins(trail)).toEqual([0, 3]);
    // A drawer that follows sees every point as new.
    expect(trail.added - seen).toBeGreaterThanOrEqual(trail.length);
  });

  test('keeps what a server that was started anew has forgotten', () => {
    const trail = new Trail(10);
    for (const k of [1, 2, 30, 31]) trail.add(north(k), k, REACH_M);
    trail.restore([piece([31, 30.5], [32, 32])], 33);
    expect(metres(trail)).toEqual([1, 2, 30, 31, 32]);
    expect(begins(trail)).toEqual([1, 30, 31]);
    trail.restore([], 40);
    expect(metres(trail)).toEqual([1, 2, 30, 31, 32]);
  });
});

describe('tracks', () => {
  const vehicle = (
    t_s: number,
    at: number,
    received: number,
    { stale = false, speed_mps = 1, state = 'idle', cross_track_m = null as number | null } = {},
  ) =>
    ({
      time: new Date(t_s * 1000).toISOString(),
      position: { ...north(at), stale, speed_mps },
      mission: { state, cross_track_m },
      gnss: { ...north(received), fix: 'gps', stale: false },
    }) as unknown as Vehicle;

  test('grow with the stream, but not with positions that are old', () => {
    const tracks = new Tracks();
    tracks.take(vehicle(1, 1, 2));
    tracks.take(vehicle(2, 5, 3, { stale: true }));
    expect(metres(tracks.driven)).toEqual([1]);
    expect(metres(tracks.fixes)).toEqual([2, 3]);
    expect(tracks.places()).toHaveLength(3);
    expect(tracks.full).toBe(false);
  });

  test('jump where the speed of the robot does not explain the way', () => {
    const tracks = new Tracks();
    tracks.take(vehicle(1, 0, 0, { speed_mps: 0 }));
    tracks.take(vehicle(2, 1, 1, { speed_mps: 0 }));
    tracks.take(vehicle(3, 5, 5, { speed_mps: 0 }));
    tracks.take(vehicle(4, 10, 10, { speed_mps: -2 }));
    expect(begins(tracks.driven)).toEqual([0, 5]);
    expect(begins(tracks.fixes)).toEqual([0]);
  });

  test('join the memory of the server and the stream: nothing twice, nothing missing', () => {
    const tracks = new Tracks();
    // The page asks at 4 s, the server answers with the way up to 6 s, and that comes at 8 s.
    for (const t of [4, 5, 6, 7, 8]) tracks.take(vehicle(t, t, t + 100));
    tracks.restore({
      until_s: 6,
      estimated: [piece([0, 0], [2, 2], [4, 4], [6, 6])],
      received: [piece([100, 0], [102, 2], [104, 4], [106, 6])],
    });
    tracks.take(vehicle(9, 9, 109));
    expect(metres(tracks.driven)).toEqual([0, 2, 4, 6, 7, 8, 9]);
    expect(begins(tracks.driven)).toEqual([0]);
    expect(metres(tracks.fixes)).toEqual([100, 102, 104, 106, 107, 108, 109]);
  });

  test('have no hole after a reconnect', () => {
    const tracks = new Tracks();
    for (const t of [1, 2]) tracks.take(vehicle(t, t, t));
    for (const t of [7, 8]) tracks.take(vehicle(t, t, t));
    tracks.restore({
      until_s: 7,
      estimated: [piece([1, 1], [3, 3], [5, 5], [7, 7])],
      received: [],
    });
    expect(metres(tracks.driven)).toEqual([1, 3, 5, 7, 8]);
  });

  test('know what was measured while this page listened, also after the server has told the way', () => {
    const tracks = new Tracks();
    const at_5 = { state: 'running', cross_track_m: -0.07, speed_mps: -0.8 };
    tracks.take(vehicle(5, 5, 5, at_5));
    tracks.take(vehicle(6, 6, 6, { ...at_5, state: 'paused' }));
    tracks.restore({
      until_s: 6.2,
      estimated: [piece([1, 1], [3, 3.9], [5, 4.8], [6, 6.2])],
      received: [],
    });
    const told = (k: number): readonly number[] => {
      const { speed_mps, off_m } = tracks.driven.driven(k);
      return [speed_mps, off_m].map((value) => Math.round(value * 100) / 100);
    };
    expect([0, 1, 2, 3].map(told)).toEqual([
      [NaN, NaN],
      [NaN, NaN],
      [0.8, 0.07],
      [0.8, NaN],
    ]);
    expect(tracks.driven.driven(4)).toEqual({ speed_mps: NaN, off_m: NaN });
  });
});
