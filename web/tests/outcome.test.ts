import { describe, expect, test } from 'vitest';

import { outcome, type Wish } from '../src/model/outcome';
import type { Vehicle } from '../src/model/vehicle';

const robot = (given: object = {}): Vehicle =>
  ({
    armed: false,
    estop: false,
    mode: 'HOLD',
    home: null,
    activity: { id: 3, kind: null, state: 'none', reason: '', distance_m: null, turn_deg: null },
    mission: { id: null, revision: null, name: null, state: 'idle', current_item: null },
    ...given,
  }) as unknown as Vehicle;
const going = (id: number, kind: string): object => ({
  mode: 'GUIDED',
  activity: { id, kind, state: 'driving', reason: '', distance_m: 5.25, turn_deg: null },
});
const mission = (given: object): object => ({
  mission: { id: 'a', revision: 2, name: 'Field', state: 'loaded', current_item: 1, ...given },
});

describe('what became of a command without an answer', () => {
  const told = (wish: Wish, before: object, after: object): readonly [boolean | null, string] => {
    const { obeyed, detail } = outcome(wish, robot(before), robot(after));
    return [obeyed, detail];
  };

  test('arming and the reset of a stop are seen in the state', () => {
    expect(told({ to: 'arm' }, {}, { armed: true })).toEqual([true, 'the robot is armed']);
    expect(told({ to: 'arm' }, {}, {})).toEqual([false, 'the robot is not armed']);
    expect(told({ to: 'reset' }, { estop: true }, {})[0]).toBe(true);
    expect(told({ to: 'reset' }, { estop: true }, { estop: true })[0]).toBe(false);
  });

  test('that a person looked is seen in the conditions', () => {
    const waiting = { safety: [{ id: 'estimate_latched', detail: 'set anew 3 m away' }] };
    expect(told({ to: 'acknowledge' }, waiting, { safety: [] })).toEqual([true, 'it was taken']);
    expect(told({ to: 'acknowledge' }, waiting, waiting)[0]).toBe(false);
  });

  test('a drive to a place is obeyed only if it is another one than before', () => {
    const wish: Wish = { to: 'do', kinds: ['goto'] };
    expect(told(wish, {}, going(4, 'goto'))).toEqual([true, 'going to the place: 5.25 m left']);
    expect(told(wish, going(4, 'goto'), going(4, 'goto'))[0]).toBe(false);
    expect(told(wish, {}, going(4, 'turn'))[0]).toBe(false);
    expect(told(wish, {}, {})).toEqual([false, 'the mode is HOLD']);
    expect(outcome(wish, null, robot(going(4, 'goto'))).obeyed).toBe(true);
  });

  test('modes, missions and home', () => {
    expect(told({ to: 'mode', mode: 'RTL' }, {}, { mode: 'RTL' })[0]).toBe(true);
    expect(told({ to: 'mode', mode: 'RTL' }, {}, {})).toEqual([false, 'the mode is HOLD']);
    const load: Wish = { to: 'load', id: 'a', revision: 2 };
    expect(told(load, {}, mission({}))).toEqual([true, '“Field” revision 2 is loaded']);
    expect(told(load, {}, mission({ revision: 1 }))[0]).toBe(false);
    expect(told(load, {}, {})).toEqual([false, 'no mission is loaded']);
    const there = { lat: 58, lon: 26 };
    const stand: Wish = { to: 'stand', at: there };
    expect(told(stand, {}, { position: there })).toEqual([
      true,
      'it takes itself to stand 0.0 cm from there',
    ]);
    expect(told(stand, {}, { position: { lat: 58.001, lon: 26 } })[0]).toBeNull();
    // It was there before, and only its heading was told: nobody knows.
    expect(told(stand, { position: there }, { position: there })[0]).toBeNull();
    const far = { lat: 58.001, lon: 26 };
    expect(told(stand, { position: far }, { position: there })[0]).toBe(true);
    expect(told(stand, {}, { position: { lat: null, lon: null } })[0]).toBe(false);
    const run: Wish = { to: 'run' };
    const stays = mission({ state: 'running', waits_for_word: true });
    expect(told(run, stays, mission({ state: 'running', waits_for_word: false }))[0]).toBe(true);
    expect(told(run, stays, stays)[0]).toBe(false);
    expect(told(run, mission({}), mission({ state: 'running' }))[0]).toBe(true);
    expect(told(run, mission({}), mission({}))).toEqual([false, 'the mission is loaded']);
    expect(told(run, mission({ state: 'finished' }), mission({ state: 'finished' }))[0]).toBe(
      false,
    );
    expect(told({ to: 'skip' }, mission({}), mission({ current_item: 2 }))[0]).toBeNull();
    expect(told({ to: 'skip' }, mission({}), mission({}))[0]).toBe(false);
    const held = { mode: 'GUIDED', activity: { id: 4, kind: 'goto', state: 'held' } };
    expect(told({ to: 'go_on' }, held, going(4, 'goto'))[0]).toBe(true);
    expect(told({ to: 'go_on' }, held, held)).toEqual([false, 'the mode is GUIDED']);
    const at = { lat: 58, lon: 26 };
    expect(told({ to: 'home', at }, {}, { home: at })[0]).toBe(true);
    expect(told({ to: 'home', at }, {}, { home: { lat: 58.001, lon: 26 } })[0]).toBe(false);
    expect(told({ to: 'home', at }, {}, {})[0]).toBe(false);
  });
});
