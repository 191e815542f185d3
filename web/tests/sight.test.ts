import View from 'ol/View';
import { describe, expect, test } from 'vitest';

import { from_plane } from '../src/map/projection';
import { fit_beside } from '../src/map/fit_beside';
import { fit_in, free_part, make_fit, pixel_of } from '../src/map/sight';
import type { LatLon } from '../src/model/plan';

const SIZE = [1000, 800] as const;
const STOP = { left: 776, top: 684, right: 976, bottom: 776 };
const CAMERA = { left: 376, top: 116, right: 636, bottom: 360 };

/** Beside a panel of 360 px and below a header of 100. */
const free = free_part(SIZE, { top: 100, right: 0, bottom: 0, left: 360 });

const view_of = (): View => {
  const view = new View({ center: [0, 0], zoom: 18, maxZoom: 25, constrainRotation: false });
  view.padding = [100, 0, 0, 360];
  view.setViewportSize([...SIZE]);
  return view;
};
const fit = (view: View, points: readonly LatLon[], over: readonly (typeof STOP)[]): void => {
  fit_beside(view, fit_in(view, points, free, 21), free, over);
};
const at = (right_m: number, up_m: number): LatLon => from_plane([right_m, up_m]);
const in_it = ([x, y]: readonly [number, number], box: typeof STOP): boolean =>
  x > box.left && x < box.right && y > box.top && y < box.bottom;

describe('what is fitted into the map', () => {
  const across = [at(0, 60), at(70, 0)]; // from the upper left to the lower right

  test('lies as large as it can where nothing stands over it', () => {
    const view = view_of();
    fit(view, across, []);
    const [first, last] = across.map((each) => pixel_of(view, each, free));
    expect(last?.[0]).toBeCloseTo(912, 0);
    expect((last?.[0] ?? 0) - (first?.[0] ?? 0)).toBeCloseTo(640 - 48 - 88, 0);
  });

  test.each([
    ['the stop button', [STOP]],
    ['the camera', [CAMERA]],
    ['either', [STOP, CAMERA]],
  ])('has no place beneath %s', (_, over) => {
    const view = view_of();
    // High enough to reach into both corners.
    const points = [at(0, 66), at(70, 0)];
    fit(view, points, []);
    const before = points.map((each) => pixel_of(view, each, free));
    expect(over.every((box) => before.some((pixel) => in_it(pixel, box)))).toBe(true);

    fit(view, points, over);
    for (const pixel of points.map((each) => pixel_of(view, each, free))) {
      expect(over.some((box) => in_it(pixel, box))).toBe(false);
      expect(pixel[0]).toBeGreaterThan(360 + 40);
      expect(pixel[0]).toBeLessThan(1000 - 80);
      expect(pixel[1]).toBeGreaterThan(100 + 40);
      expect(pixel[1]).toBeLessThan(800 - 40);
    }
  });

  test('stays as it is where what stands over the map covers no place of it', () => {
    const points = [at(0, 0), at(70, 60)]; // from the lower left to the upper right
    const [plain, beside] = [view_of(), view_of()];
    fit(plain, points, []);
    fit(beside, points, [STOP, CAMERA]);
    expect(beside.getResolution()).toBe(plain.getResolution());
    expect(beside.getCenter()).toEqual(plain.getCenter());
  });

  test('lies beneath it rather than nowhere', () => {
    const view = view_of();
    const all = { left: 0, top: 0, right: 1000, bottom: 800 };
    fit(view, across, [all]);
    const plain = view_of();
    fit(plain, across, []);
    expect(view.getResolution()).toBe(plain.getResolution());
  });

  describe('while the code for that is still to come', () => {
    const beneath = [at(0, 66), at(70, 0)];
    const late = () => {
      const view = view_of();
      let cleared = 0;
      let come: () => void = () => undefined;
      let fail: () => void = () => undefined;
      const code = new Promise<void>((resolve, reject) => ([come, fail] = [resolve, reject]));
      const fits = make_fit(view, async () => {
        await code;
        return {
          fit_beside,
          keep_clear: (of, fitted, part) => {
            cleared += 1;
            fit_beside(of, fitted, part, [STOP]);
          },
        };
      });
      const fitted = (points: readonly LatLon[]) =>
        fits(points, free, 21, undefined as unknown as HTMLElement);
      return { view, cleared: () => cleared, come: () => come(), fail: () => fail(), fitted };
    };
    const hidden = (view: View): boolean =>
      beneath.some((each) => in_it(pixel_of(view, each, free), STOP));

    test('is moved out from beneath as soon as it comes', async () => {
      const { view, come, fitted } = late();
      const done = fitted(beneath);
      expect(hidden(view)).toBe(true);
      come();
      await done;
      expect(hidden(view)).toBe(false);
    });

    test.each([
      ['panned', (view: View) => view.setCenter([500, 500])],
      ['zoomed', (view: View) => view.setZoom(15)],
    ])('stays as it is where somebody has %s since', async (_, move) => {
      const { view, cleared, come, fitted } = late();
      const done = fitted(beneath);
      move(view);
      const [center, resolution] = [view.getCenter(), view.getResolution()];
      come();
      await done;
      expect(cleared()).toBe(0);
      expect([view.getCenter(), view.getResolution()]).toEqual([center, resolution]);
    });

    test('counts only if nothing else was fitted since, even in the same place', async () => {
      const { view, cleared, come, fitted } = late();
      const both = [fitted([at(0, 0), at(0, 66), at(70, 66)]), fitted(beneath)];
      come();
      await Promise.all(both);
      expect(cleared()).toBe(1);
      expect(hidden(view)).toBe(false);
    });

    test('stays as it is where it never comes', async () => {
      const { view, fail, fitted } = late();
      const done = fitted(beneath);
      fail();
      await expect(done).resolves.toBeUndefined();
      expect(hidden(view)).toBe(true);
    });
  });
});
