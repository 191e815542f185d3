// What stands in the way, in words, on the map and as a sound.

import { afterEach, describe, expect, it } from 'vitest';

import { bearing_deg, distance_m } from '../src/model/geo';
import {
  may_override,
  obstacle_line,
  obstacle_place,
  obstacle_since,
  sound_of,
  type Obstacle,
} from '../src/model/obstacle';
import { IN_ENGLISH, speak } from '../src/model/say';
import { late as english_late } from '../src/texts/en/late';
import { finnish } from '../src/texts/fi';
import { late as finnish_late } from '../src/texts/fi/late';

afterEach(() => speak(() => IN_ENGLISH));

const HERE = { lat: 58.378, lon: 26.729 };
const wall: Obstacle = {
  action: 'stop',
  what: 'obstacle',
  distance_m: 2,
  bearing_deg: -30,
  sensor: 'front',
  age_s: 0.1,
  stopped_s: 12.3,
  reason: 'something stands in the way, 2.0 m ahead, to the left, seen by front',
};

describe('its words', () => {
  it('say what it is, and that a slower robot still drives', () => {
    expect(obstacle_line(wall)).toBe(
      'Something stands in the way, 2.0 m ahead, to the left, seen by front.',
    );
    expect(obstacle_line({ ...wall, action: 'slow', reason: 'a thing' })).toBe(
      'It slows: a thing.',
    );
    expect(obstacle_line({ ...wall, action: 'creep', reason: 'a thing' })).toBe(
      'It creeps: a thing.',
    );
  });
  it('say since when, also while the link is late', () => {
    expect(obstacle_since(wall, 0)).toBe('For 12 s.');
    expect(obstacle_since(wall, 3)).toBe('For 15 s.');
    expect(obstacle_since({ ...wall, stopped_s: 150 }, 0)).toBe('For 3 min.');
    expect(obstacle_since({ ...wall, stopped_s: null }, 0)).toBe('');
  });
  it('say what comes of waiting where the robot tells it', () => {
    const waits = { ...wall, since_s: 12, blocked: false, then: 'around', decides_in_s: 8 };
    expect(obstacle_since(waits, 0)).toBe('For 12 s. In 8 s it looks for a way around.');
    expect(obstacle_since(waits, 3)).toBe('For 15 s. In 5 s it looks for a way around.');
    const blocked = { ...waits, blocked: true, decides_in_s: null };
    expect(obstacle_since(blocked, 0)).toBe('For 12 s. Blocked: it looks for a way around.');
    expect(obstacle_since({ ...blocked, then: 'back_off' }, 0)).toBe(
      'For 12 s. Blocked: back off.',
    );
    expect(obstacle_since({ ...blocked, then: null }, 0)).toBe('For 12 s. Blocked.');
    expect(obstacle_since({ ...waits, then: 'wait' }, 0)).toBe(
      'For 12 s. In 8 s it counts as blocked.',
    );
    const none = { ...blocked, no_way: 'the corridor leaves no way' };
    expect(obstacle_since(none, 0)).toBe('For 12 s. No way around it: the corridor leaves no way.');
  });

  it('says in the language that is chosen why there is no way around it', () => {
    const texts = { ...finnish, ...finnish_late };
    speak(() => ({ language: 'fi', texts, late: english_late }));
    const none = { ...wall, no_way: 'item 4 lies in what stands there' };
    expect(obstacle_since(none, 0)).toMatch(
      /Sitä ei voi kiertää: kohta 4 on siinä, mikä siellä seisoo\.$/,
    );
  });
});

describe('its place', () => {
  it('lies by its distance and bearing from the robot, as that faces', () => {
    const place = obstacle_place(wall, HERE, 90);
    expect(place && distance_m(HERE, place)).toBeCloseTo(2, 3);
    expect(place && bearing_deg(HERE, place)).toBeCloseTo(60, 2);
  });
  it('is not known of a picture that is too old, or of a robot that is lost', () => {
    expect(obstacle_place({ ...wall, what: 'blind' }, HERE, 90)).toBeNull();
    expect(obstacle_place(wall, HERE, null)).toBeNull();
    expect(obstacle_place(wall, null, 90)).toBeNull();
    expect(obstacle_place(null, HERE, 90)).toBeNull();
  });
});

describe('its sound', () => {
  it('is for a stop, for what is free again, and for what is blocked', () => {
    expect(sound_of('obstacle')).toBe('stopped');
    expect(sound_of('obstacle_gone')).toBe('free');
    expect(sound_of('blocked')).toBe('blocked');
    expect(sound_of('armed')).toBeNull();
  });
});

describe('the hand that holds the guard off', () => {
  it('is offered only while the guard limits a stick', () => {
    expect(may_override(wall, 'held')).toBe(true);
    expect(may_override(wall, 'ready')).toBe(true);
    expect(may_override(wall, 'off')).toBe(false);
    expect(may_override(null, 'held')).toBe(false);
    expect(may_override(undefined, undefined)).toBe(false);
  });
});
