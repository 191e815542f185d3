// What only reads may be asked twice: what still waits when the live stream is back is asked anew, and for some
// seconds whatever is not answered soon (model/anew.ts).

import { try_limit_ms } from '../model/anew';

const waiting = new Set<AbortController>();
let back_ms = -Infinity;

/** The live stream is open again, after it was lost. */
export const ask_anew = (): void => {
  back_ms = performance.now();
  for (const hang_up of waiting) hang_up.abort();
};

/** @param ask one try, which the signal ends */
export const asked_anew = async <T>(ask: (signal: AbortSignal) => Promise<T>): Promise<T> => {
  for (let tries = 0; ; tries += 1) {
    const hang_up = new AbortController();
    const limit = try_limit_ms(tries, performance.now() - back_ms);
    const timer = limit === undefined ? undefined : setTimeout(() => hang_up.abort(), limit);
    waiting.add(hang_up);
    try {
      return await ask(hang_up.signal);
    } catch (cause) {
      if (!hang_up.signal.aborted) throw cause;
    } finally {
      clearTimeout(timer);
      waiting.delete(hang_up);
    }
  }
};
