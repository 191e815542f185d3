import { describe, expect, test } from 'vitest';

import type { LatLon } from '../src/model/plan';
import { Trail, type TrailPiece } from '../src/model/trail';
import { TrailColumns } from '../src/model/trail_columns';

// Of the runtime of the tests (vitest.config.ts), not of browsers.
declare const gc: () => void;
declare const process: { memoryUsage(): { readonly heapUsed: number } };

const REACH_M = 10;
const north = (metres: number) => ({ lat: 58 + metres / 111_000, lon: 26 });
const measured = { speed_mps: 0.8, off_m: 0.013 };
const drive = (trail: Trail, from: number, to: number): void => {
  for (let k = from; k < to; k += 1) trail.add(north(k), k, REACH_M, measured);
};
const to_plane = ({ lat, lon }: LatLon): readonly [number, number] => [lon, (lat - 58) * 111_000];
const metres = (line: TrailColumns, begin = 0): number[] =>
  [...line.ys.subarray(line.first + begin, line.end)].map(Math.round);
const range = (from: number, to: number): number[] =>
  Array.from({ length: to - from }, (_, k) => from + k);

/** What is in use, bytes. */
const heap = (): number => {
  gc();
  return process.memoryUsage().heapUsed;
};

describe('the trail in columns', () => {
  test('has the points of the ring, also long after the ring is full', () => {
    const trail = new Trail(100, 0.05);
    const line = new TrailColumns(to_plane);
    for (let k = 0; k < 9000; k += 7) {
      drive(trail, k, k + 7);
      line.follow(trail);
    }
    expect(metres(line)).toEqual(range(9002 - 100, 9002));
    expect(metres(line, 97)).toEqual([8999, 9000, 9001]);
  });

  test('has what the robot remembers instead, whenever that comes', () => {
    const trail = new Trail(3000, 0.05);
    const line = new TrailColumns(to_plane);
    for (let k = 0; k < 4900; k += 70) {
      drive(trail, k, k + 70);
      line.follow(trail);
    }
    // when it is told of a way of 2,500 points
    const piece: TrailPiece = range(2400, 4900).map((k) => ({ ...north(k), t_s: k }));
    trail.restore([piece], 5000);
    line.follow(trail);
    // then they stand behind those that are older
    expect(metres(line)).toEqual(range(1900, 4900));
    drive(trail, 4900, 4903);
    line.follow(trail);
    expect(metres(line)).toEqual(range(1903, 4903));
  });

  test('takes no more memory after an hour than after a minute', () => {
    const trail = new Trail();
    const line = new TrailColumns(to_plane);
    const follow = (from: number, to: number): void => {
      for (let k = from; k < to; k += 1) {
        drive(trail, k, k + 1);
        line.follow(trail);
      }
    };
    follow(0, 600);
    const begun = heap();
    follow(600, 36_000);
    expect(heap() - begun).toBeLessThan(300_000);
    expect(metres(line, 35_998)).toEqual([35_998, 35_999]);
  });
});
