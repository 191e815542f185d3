// When what only reads is asked once more. Where the link was lost, connections stay behind that are dead although
// nobody told the browser; a try that is given up takes its connection along. Time is an argument.

/** As long as a probe: on a link of which the stream came back that fast. The try after these has no limit here. */
const TRIES_MS = [800, 800, 800];
const DOUBTED_MS = 10_000;

/** @param tries before this one @param back_ms since the live stream is back; Infinity: it was never lost
 * @return when this try is given up; undefined: as long as the question may last */
export const try_limit_ms = (tries: number, back_ms: number): number | undefined =>
  back_ms < DOUBTED_MS ? TRIES_MS[tries] : undefined;
