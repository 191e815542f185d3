import { describe, expect, it } from 'vitest';

import { far_words } from '../src/model/import_far';

const TARTU = { lat: 58.378, lon: 26.729 };

describe('a file that leads far away', () => {
  it('is told with its distance, also across the world', () => {
    expect(far_words({ lat: 58.5, lon: 26.729 }, TARTU)).toBe(
      'Its first place lies 13.59 km from the robot.',
    );
    expect(far_words({ lat: -33.9, lon: 151.2 }, TARTU)).not.toBeNull();
  });

  it('is asked whether latitude and longitude are exchanged, where that would bring it near', () => {
    expect(far_words({ lat: 26.73, lon: 58.379 }, TARTU)).toMatch(
      /from the robot\. With latitude and longitude exchanged it would be 1\d\d m: look whether they are\.$/,
    );
  });

  it('is not asked so where that lies as far, or is no place at all', () => {
    expect(far_words({ lat: 59.5, lon: 24.7 }, TARTU)).not.toContain('exchanged');
    expect(far_words({ lat: 10, lon: 120 }, TARTU)).not.toContain('exchanged');
  });

  it('is nothing worth a word where it is near, or nobody knows how far it is', () => {
    expect(far_words({ lat: 58.4, lon: 26.73 }, TARTU)).toBeNull();
    expect(far_words({ lat: 26.7, lon: 58.4 }, null)).toBeNull();
    expect(far_words(undefined, TARTU)).toBeNull();
  });
});
