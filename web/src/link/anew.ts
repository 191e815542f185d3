// Where the link was lost, connections stay behind that are dead although nobody told the browser, and it asks
// over them again. What only reads may be asked twice: what still waits when the live stream is back is asked
// anew, and for some seconds whatever is not answered soon. A try that is given up takes its connection along.

/** As long as a probe: on a link of which the stream came back that fast. The try after these has no limit here. */
const TRIES_MS = [800, 800, 800];
const DOUBTED_MS = 10_000;

const waiting = new Set<AbortController>();
let back_ms = -Infinity;

/** The live stream is open again, after it was lost. */
export const ask_anew = (): void => {
  back_ms = performance.now();
  for (const hang_up of waiting) hang_up.abort();
};

const limit_ms = (tries: number): number | undefined =>
  performance.now() - back_ms < DOUBTED_MS ? TRIES_MS[tries] : undefined;

/** @param ask one try, which the signal ends */
export const asked_anew = async <T>(ask: (signal: AbortSignal) => Promise<T>): Promise<T> => {
  for (let tries = 0; ; tries += 1) {
    const hang_up = new AbortController();
    const limit = limit_ms(tries);
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
