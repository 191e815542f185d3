// A browser opens six connections to one robot and lets every further request wait. So that a stop
// finds one that is free, all others keep to their lanes: one command, two of everything else, one
// map tile (the map room sees to that). Two are left for what stops.

export type Lane = 'halt' | 'command' | 'other';

const ROOM: Readonly<Record<Exclude<Lane, 'halt'>, number>> = { command: 1, other: 2 };

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

const queues = { command: new Queue(ROOM.command), other: new Queue(ROOM.other) };

/** Runs a request when its lane has room; what stops never waits. */
export const in_lane = async <T>(lane: Lane, run: () => Promise<T>): Promise<T> => {
  if (lane === 'halt') return run();
  await queues[lane].enter();
  try {
    return await run();
  } finally {
    queues[lane].leave();
  }
};
