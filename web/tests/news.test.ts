// What the robot's events are called, in the language of the page.

import { afterEach, expect, test } from 'vitest';

import { advice_words, news_title, title_before } from '../src/model/news';
import { IN_ENGLISH, speak } from '../src/model/say';
import { ended_driving } from '../src/model/happened';
import type { StationEvent } from '../src/model/vehicle';
import { finnish } from '../src/texts/fi';

afterEach(() => speak(() => IN_ENGLISH));

test('who reads English has the robot’s own sentence, and no title that says it again', () => {
  expect(title_before('gnss_lost')).toBeNull();
  expect(news_title('gnss_lost')).toBe('No usable position');
});

test('in another language a title comes first; what the page does not know is left to the robot', () => {
  speak(() => ({ language: 'fi', texts: finnish }));
  expect(title_before('gnss_lost')).toBe('Ei käyttökelpoista sijaintia');
  expect(title_before('mission_finished')).toBe('Tehtävä valmis');
  expect(title_before('of_tomorrow')).toBeNull();
  expect(news_title('of_tomorrow')).toBe('of tomorrow');
});

test('no stable word is taken for a part of the language it is written in', () => {
  speak(() => ({ language: 'fi', texts: finnish }));
  for (const word of ['constructor', 'toString']) expect(title_before(word)).toBeNull();
});

test('advice that the page knows is in its language, other advice as it came', () => {
  expect(advice_words('drive 3 m straight to find the heading')).toBe(
    'Drive 3 m straight to find the heading',
  );
  speak(() => ({ language: 'fi', texts: finnish }));
  expect(advice_words('drive 3 m straight to find the heading')).toMatch(/^Aja 3 m suoraan/);
  expect(advice_words('dance')).toBe('Dance');
});

test('what ends the driving is told from what does not', () => {
  const event = (kind: string, detail = ''): StationEvent => ({
    time: '2026-05-04T10:00:00Z',
    level: 'info',
    kind,
    detail,
  });
  expect(ended_driving(event('mode', 'mode HOLD: no word from the base for 7.1 s'))).toBe(true);
  expect(ended_driving(event('mode', 'mode MANUAL: chosen'))).toBe(false);
  for (const kind of ['mission_paused', 'mission_aborted', 'blocked', 'stopped', 'estop'])
    expect(ended_driving(event(kind))).toBe(true);
  expect(ended_driving(event('mission_finished'))).toBe(false);
  expect(ended_driving(event('driver_up'))).toBe(false);
});
