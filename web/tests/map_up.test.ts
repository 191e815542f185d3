import { describe, expect, it } from 'vitest';

import { angle_between, turn_deg, turned, type TurnWanted } from '../src/model/map_up';

const FOLLOWING: TurnWanted = {
  up: 'heading',
  drawn_on: false,
  follows: true,
  heading_deg: 90,
};

describe('how far the map is turned', () => {
  it('brings the heading up: a robot that looks east turns the map a quarter to the left', () => {
    expect(turn_deg(0, FOLLOWING)).toBe(-90);
    expect(turn_deg(0, { ...FOLLOWING, heading_deg: 350 })).toBe(10);
  });

  it('stays with north up where the person wants that, and while one draws', () => {
    expect(turn_deg(40, { ...FOLLOWING, up: 'north' })).toBe(0);
    expect(turn_deg(40, { ...FOLLOWING, drawn_on: true })).toBe(0);
  });

  it('stays as it lies while another place is looked at, or no heading is known', () => {
    expect(turn_deg(40, { ...FOLLOWING, follows: false })).toBe(40);
    expect(turn_deg(40, { ...FOLLOWING, heading_deg: null })).toBe(40);
  });

  it('does not tremble with the noise of the heading, across north either', () => {
    expect(turn_deg(-90, { ...FOLLOWING, heading_deg: 91.9 })).toBe(-90);
    expect(turn_deg(-90, { ...FOLLOWING, heading_deg: 92.1 })).toBeCloseTo(-92.1);
    expect(turn_deg(0.5, { ...FOLLOWING, heading_deg: 1 })).toBe(0.5);
    expect(turn_deg(179.5, { ...FOLLOWING, heading_deg: 179 })).toBe(179.5);
  });
});

describe('turning', () => {
  it('is clockwise where y points down', () => {
    const [x, y] = turned([1, 0], Math.PI / 2);
    expect(x).toBeCloseTo(0);
    expect(y).toBeCloseTo(1);
  });

  it('goes the short way around', () => {
    expect(angle_between(Math.PI - 0.1, -Math.PI + 0.1)).toBeCloseTo(0.2);
    expect(angle_between(-Math.PI + 0.1, Math.PI - 0.1)).toBeCloseTo(-0.2);
  });
});
