import { describe, expect, test } from 'vitest';

import { kept_as, robot_first } from '../src/worker/keeping';

const HERE = 'https://robot.local:8443';
const PARTS = ['/assets/index-1.js', '/icon.svg'];
const kept = (path: string, more: object = {}) =>
  kept_as({ method: 'GET', url: `${HERE}${path}`, opens: false, ...more }, HERE, PARTS);

describe('what may be answered without the robot', () => {
  test('the page, what it is made of, and the ground', () => {
    expect(kept('/', { opens: true })).toBe('page');
    expect(kept('/index.html?x=1', { opens: true })).toBe('page');
    expect(kept('/assets/index-1.js')).toBe('part');
    expect(kept('/api/v1/tiles')).toBe('ground');
    expect(kept('/api/v1/tiles/farm%20a/17/70000/40000')).toBe('ground');
  });

  test('nothing that tells of the robot, and nothing that changes it', () => {
    for (const path of [
      '/api/v1/vehicle',
      '/api/v1/missions',
      '/api/v1/health',
      '/api/v1/tiles/a/1/2',
      '/api/v1/tiles/../vehicle',
      '/api/v1/session',
      '/docs',
      '/',
      '/assets/other.js',
    ]) {
      expect(kept(path)).toBeNull();
    }
    expect(kept('/pair', { opens: true })).toBeNull();
    expect(kept('/', { opens: true, method: 'POST' })).toBeNull();
    expect(kept('/api/v1/tiles', { method: 'DELETE' })).toBeNull();
    expect(
      kept_as({ method: 'GET', url: 'https://else/icon.svg', opens: false }, HERE, PARTS),
    ).toBeNull();
  });
});

describe('the robot has the first word', () => {
  const never = new Promise<string>(() => undefined);

  test('what it answers in time is taken, and what was kept is not even looked at', async () => {
    const look = () => Promise.reject(new Error('looked'));
    expect(await robot_first(Promise.resolve('new'), look, 50)).toBe('new');
  });

  test('where it is silent or cannot be reached, what was kept', async () => {
    const old = () => Promise.resolve('old');
    expect(await robot_first(never, old, 5)).toBe('old');
    expect(await robot_first(Promise.reject(new Error('no route')), old, 5000)).toBe('old');
  });

  test('with nothing kept a late answer counts, and a refusal is one', async () => {
    const nothing = () => Promise.resolve(undefined);
    const late = new Promise<string>((resolve) => setTimeout(() => resolve('late'), 20));
    expect(await robot_first(late, nothing, 1)).toBe('late');
    await expect(robot_first(Promise.reject(new Error('no')), nothing, 1)).rejects.toThrow('no');
  });
});
