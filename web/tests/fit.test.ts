import View from 'ol/View';
import { describe, expect, it } from 'vitest';

import { fit_in, free_part, pixel_of } from '../src/map/sight';
import type { LatLon } from '../src/model/plan';

/** A phone's map; its buttons take the last 58 pixels on the right. */
const SIZE = [390, 330] as const;
const free = free_part(SIZE, { top: 0, right: 0, bottom: 0, left: 0 });
const METRE = { lat: 1 / 111_300, lon: 1 / 58_300 };

const shown = (wide_m: number, high_m: number): number[] => {
  const points: readonly LatLon[] = [
    { lat: 58, lon: 26 },
    { lat: 58 + high_m * METRE.lat, lon: 26 + wide_m * METRE.lon },
  ];
  const view = new View({ center: [0, 0], zoom: 2, constrainResolution: false });
  view.setViewportSize([...SIZE]);
  fit_in(view, points, free, 21);
  return points.map((at) => pixel_of(view, at, free)[0]);
};

describe('what is fitted into the map', () => {
  it('lies beneath none of its buttons, however wide it is', () => {
    const [left = 0, right = 0] = shown(400, 10);
    expect(left).toBeGreaterThan(40);
    expect(right).toBeLessThan(390 - 58 - 15);
  });

  it('is in the middle where there is room', () => {
    const [left = 0, right = 0] = shown(5, 200);
    expect((left + right) / 2).toBeCloseTo(195, 0);
  });
});
