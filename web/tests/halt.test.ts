import { describe, expect, test } from 'vitest';

import {
  begin_halt,
  halt_line,
  halt_words,
  halted,
  HELP_AFTER_MS,
  next_try_ms,
  over,
  tried_again,
  with_answer,
  with_state,
  type Halt,
} from '../src/model/halt';
import type { ExecutionState, Vehicle } from '../src/model/vehicle';

interface Given {
  readonly armed?: boolean;
  readonly estop?: boolean;
  readonly mode?: string;
  readonly state?: ExecutionState;
}
const robot = ({ armed, estop, mode, state }: Given): Vehicle =>
  ({
    armed: armed ?? true,
    estop: estop ?? false,
    mode: mode ?? 'AUTO',
    mission: { state: state ?? 'running' },
  }) as unknown as Vehicle;

const DRIVING = robot({});
const DONE: Record<Halt, Vehicle> = {
  estop: robot({ estop: true }),
  hold: robot({ mode: 'HOLD' }),
  pause: robot({ state: 'paused' }),
  disarm: robot({ armed: false }),
  stop: robot({ state: 'aborted' }),
};
const ALL = Object.keys(halt_words) as Halt[];

describe('halts', () => {
  test('each is done by its own state of the robot, and by no state that drives on', () => {
    expect(ALL).toHaveLength(5);
    for (const halt of ALL) {
      expect(halted(halt, DRIVING), halt).toBe(false);
      expect(halted(halt, DONE[halt]), halt).toBe(true);
    }
    expect(halted('stop', DONE.pause)).toBe(false);
    expect(halted('stop', robot({ state: 'blocked' }))).toBe(false);
    expect(halted('pause', robot({ state: 'blocked' }))).toBe(true);
  });

  test('only a state that is younger than the press confirms', () => {
    for (const halt of ALL) {
      const at = begin_halt(halt, 1000, 500, null);
      expect(with_state(at, DONE[halt], 499.9, 1100), halt).toBe(at);
      expect(with_state(at, DRIVING, 501, 1100), halt).toBe(at);
      expect(with_state(at, DONE[halt], 500, 1100), halt).toMatchObject({
        state: 'confirmed',
        ended_ms: 1100,
      });
    }
  });

  test('a start that is still on its way keeps the stop going until it can no longer be obeyed', () => {
    // Clicked at 499.8 s of the robot's clock, the start may be obeyed until 500.8 s.
    const at = begin_halt('hold', 1000, 500, 500.8);
    expect(with_state(at, DONE.hold, 500.5, 1500).state).toBe('trying');
    expect(with_answer(at, 200, '', false, 1500).state).toBe('trying');
    expect(with_state(at, DONE.hold, 500.81, 1900).state).toBe('confirmed');
    expect(with_answer(at, 200, '', true, 1900).state).toBe('confirmed');
  });

  test('where the robot’s clock is not known, only an answer confirms', () => {
    const at = begin_halt('hold', 1000, null, null);
    expect(with_state(at, DONE.hold, 1e9, 1100).state).toBe('trying');
    expect(with_answer(at, 200, '', true, 1100).state).toBe('confirmed');
  });

  test('no answer, a full queue and a lost login are no end; a state of the robot’s is', () => {
    const at = begin_halt('pause', 1000, 500, null);
    for (const status of [0, 401, 403, 429, 500, 503]) {
      expect(with_answer(at, status, 'busy', true, 1100), String(status)).toBe(at);
    }
    const refused = with_answer(at, 409, 'no mission runs', true, 1100);
    expect(refused).toMatchObject({ state: 'refused', detail: 'no mission runs' });
    expect(with_answer(refused, 200, '', true, 1200)).toBe(refused);
    const stop = begin_halt('estop', 1000, 500, null);
    expect(with_answer(stop, 409, 'no', true, 1100)).toBe(stop);
  });

  test('it is tried again soon at first, then once a second or once a round trip', () => {
    let at = begin_halt('hold', 0, 500, null);
    const due: number[] = [];
    for (let k = 0; k < 5; k += 1) {
      const next = next_try_ms(at, 0.01);
      due.push(next);
      at = tried_again(at, next);
    }
    expect(due).toEqual([300, 900, 1900, 2900, 3900]);
    expect(next_try_ms(at, 3) - at.tried_ms).toBe(3000);
    expect(next_try_ms(at, 60) - at.tried_ms).toBe(4000);
  });

  test('it says how often and how long, then what else stops the robot, then that it is done', () => {
    let at = begin_halt('hold', 1000, 500, null);
    expect(halt_line(at, 1200)).toBeNull();
    at = tried_again(tried_again(at, 1300), 1900);
    expect(halt_line(at, 2400)).toEqual({
      tone: 'bad',
      head: 'HOLD: stopping…',
      detail: 'not confirmed yet, 3rd try, 1.4 s.',
    });
    expect(halt_line(at, 1000 + HELP_AFTER_MS)?.detail).toContain('on the robot or the radio');
    const words = [4, 11, 12, 13, 21, 22, 23, 112].map(
      (tries) => /\d+(st|nd|rd|th)/.exec(halt_line({ ...at, tries }, 2400)?.detail ?? '')?.[0],
    );
    expect(words).toEqual(['4th', '11th', '12th', '13th', '21st', '22nd', '23rd', '112th']);

    const done = with_state(at, DONE.hold, 501, 2600);
    expect(halt_line(done, 2700)).toEqual({
      tone: 'good',
      head: 'HOLD confirmed',
      detail: 'by the robot, 1.6 s after the press.',
    });
    expect(over(done, 2700)).toBe(false);
    expect(over(done, 2600 + 4001)).toBe(true);
    expect(halt_line(done, 2600 + 4001)).toBeNull();
    expect(tried_again(done, 2800)).toBe(done);
    const refused = with_answer(at, 409, 'no mission runs', true, 2600);
    expect(halt_line(refused, 2700)?.detail).toBe('no mission runs');
  });

  test('one that is confirmed at once needs no words', () => {
    const at = with_state(begin_halt('hold', 1000, 500, null), DONE.hold, 501, 1100);
    expect(halt_line(at, 1150)).toBeNull();
  });
});
