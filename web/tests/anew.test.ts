import { afterAll, beforeAll, beforeEach, describe, expect, it, vi } from 'vitest';

import { ask_anew, asked_anew } from '../src/link/anew';

/** A connection that is dead: it ends only when it is given up. */
const dead = (signal: AbortSignal): Promise<string> =>
  new Promise((_, refuse) => {
    signal.addEventListener('abort', () => refuse(new DOMException('given up', 'AbortError')));
  });

/** The first so many connections are dead. */
const robot = (dead_ones: number) => {
  let tries = 0;
  return vi.fn((signal: AbortSignal) => {
    tries += 1;
    return tries <= dead_ones ? dead(signal) : Promise.resolve(`answer ${tries}`);
  });
};

describe('what only reads, over a link that was lost', () => {
  beforeAll(() => {
    vi.useFakeTimers();
  });
  afterAll(() => {
    vi.useRealTimers();
  });
  // Long after: no test doubts for another one.
  beforeEach(() => {
    vi.advanceTimersByTime(60_000);
  });

  it('is asked once where nothing was lost', async () => {
    const ask = robot(1);
    const answer = asked_anew(ask);
    await vi.advanceTimersByTimeAsync(14_000);
    expect(ask).toHaveBeenCalledTimes(1);
    ask_anew();
    expect(await answer).toBe('answer 2');
  });

  it('is asked anew when the stream is back, and soon again over every dead connection', async () => {
    const ask = robot(3);
    const answer = asked_anew(ask);
    await vi.advanceTimersByTimeAsync(4000);
    expect(ask).toHaveBeenCalledTimes(1);
    ask_anew();
    await vi.advanceTimersByTimeAsync(1650);
    expect(ask).toHaveBeenCalledTimes(4);
    expect(await answer).toBe('answer 4');
  });

  it('has all its time in the end: slow is not dead', async () => {
    ask_anew();
    const ask = robot(Infinity);
    const answer = asked_anew(ask).catch(() => 'never');
    await vi.advanceTimersByTimeAsync(20_000);
    expect(ask).toHaveBeenCalledTimes(4);
    ask.mockImplementation(() => Promise.reject(new Error('over')));
    ask_anew();
    expect(await answer).toBe('never');
  });

  it('tells a failure that was no silence at once', async () => {
    ask_anew();
    await expect(asked_anew(() => Promise.reject(new TypeError('refused')))).rejects.toThrow(
      'refused',
    );
  });
});
