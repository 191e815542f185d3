// A browser opens six connections to one robot and lets every further request wait. So that a stop
// finds one that is free, all others keep to their lanes: one command, two of everything else, of
// which one may take minutes, one map tile (the map room sees to that). Two are left for what stops.

export type Lane = 'halt' | 'command' | 'other' | 'bulk';

const ROOM = { command: 1, other: 2, bulk: 1 } as const;

class Queue {
  #free: number;
  readonly #waiting: (() => void)[] = [];

  constructor(room: number) {
    this.#free = room;
  }

  async enter(): Promise<void> {
    if (this.#free > 0) {
      this.#free -= 1;
      return;
    }
    await new Promise<void>((resolve) => this.#waiting.push(resolve));
  }

  leave(): void {
    const next = this.#waiting.shift();
    if (next) next();
    else this.#free += 1;
  }
}

const queues = {
  command: new Queue(ROOM.command),
  other: new Queue(ROOM.other),
  bulk: new Queue(ROOM.bulk),
};

const queued = async <T>(queue: Queue, run: () => Promise<T>): Promise<T> => {
  await queue.enter();
  try {
    return await run();
  } finally {
    queue.leave();
  }
};

/** Runs a request when its lane has room; what stops never waits. */
export const in_lane = async <T>(lane: Lane, run: () => Promise<T>): Promise<T> => {
  if (lane === 'halt') return run();
  if (lane !== 'bulk') return queued(queues[lane], run);
  // One of them at a time in the lane of the others: a list or a save always finds room beside it.
  return queued(queues.bulk, () => queued(queues.other, run));
};
