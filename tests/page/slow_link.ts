// A link as the field has it, between the browser and the real roverd: bytes that are late, bytes that
// stand still in one direction or both, connections that are dead although nobody closed them.

import { connect, createServer, type AddressInfo, type Server, type Socket } from 'node:net';

export type Way = 'up' | 'down';

interface Bytes {
  readonly due_ms: number;
  /** Null: the end. */
  readonly chunk: Buffer | null;
}

/** One direction of one connection. Order is kept. */
class Pump {
  readonly #queue: Bytes[] = [];
  readonly #to: Socket;
  readonly #link: SlowLink;
  readonly #way: Way;
  #timer: NodeJS.Timeout | undefined;
  /** Swallows everything for ever. */
  dead = false;

  constructor(from: Socket, to: Socket, link: SlowLink, way: Way) {
    this.#to = to;
    this.#link = link;
    this.#way = way;
    from.on('data', (chunk: Buffer) => this.#take(chunk));
    from.on('end', () => this.#take(null));
    from.on('error', () => to.destroy());
    from.on('close', () => this.#take(null));
  }

  /** Sends what is due, and looks again when the next is. */
  run(): void {
    clearTimeout(this.#timer);
    while (!this.#link.stalled.has(this.#way)) {
      const [next] = this.#queue;
      if (!next) return;
      const wait_ms = next.due_ms - performance.now();
      if (wait_ms > 0) {
        this.#timer = setTimeout(() => this.run(), wait_ms);
        return;
      }
      this.#queue.shift();
      if (next.chunk) this.#to.write(next.chunk);
      else this.#to.end();
    }
  }

  #take(chunk: Buffer | null): void {
    if (this.dead || this.#to.destroyed) return;
    if (chunk && this.#way === 'up' && this.#link.hangs?.test(chunk.toString('latin1'))) {
      this.dead = true;
      return;
    }
    const due_ms = performance.now() + this.#link.delay_ms[this.#way];
    this.#queue.push({ due_ms: Math.max(due_ms, this.#queue.at(-1)?.due_ms ?? 0), chunk });
    this.run();
  }
}

interface Connection {
  readonly sockets: readonly Socket[];
  readonly pumps: readonly Pump[];
}

export class SlowLink {
  readonly delay_ms: Record<Way, number> = { up: 0, down: 0 };
  readonly stalled = new Set<Way>();
  /** Requests that are swallowed, their connection with them. */
  hangs: RegExp | null = null;
  readonly #server: Server;
  /** Also those that the browser has closed: what it had sent before still arrives. */
  readonly #connections: Connection[] = [];

  private constructor(upstream: URL) {
    this.#server = createServer((browser) => this.#join(browser, upstream));
  }

  static async to(url: string): Promise<SlowLink> {
    const link = new SlowLink(new URL(url));
    await new Promise<void>((resolve) => link.#server.listen(0, '127.0.0.1', resolve));
    return link;
  }

  get url(): string {
    return `http://127.0.0.1:${(this.#server.address() as AddressInfo).port}`;
  }

  /** From now on, each way. */
  delay(ms: number): void {
    this.delay_ms.up = ms;
    this.delay_ms.down = ms;
  }

  /** Bytes of these ways wait, those of new connections as well. */
  stall(...ways: Way[]): void {
    for (const way of ways) this.stalled.add(way);
  }

  /** All that has waited arrives. */
  go_on(): void {
    this.stalled.clear();
    for (const { pumps } of this.#connections) for (const pump of pumps) pump.run();
  }

  /** What is open now is dead for ever, and nobody is told; new connections work. */
  lose_open_connections(): void {
    for (const { pumps } of this.#connections) for (const pump of pumps) pump.dead = true;
  }

  close(): void {
    this.#server.close();
    for (const { sockets } of this.#connections) for (const socket of sockets) socket.destroy();
  }

  #join(browser: Socket, upstream: URL): void {
    const robot = connect({ host: upstream.hostname, port: Number(upstream.port) });
    for (const socket of [browser, robot]) socket.setNoDelay(true);
    const pumps = [
      new Pump(browser, robot, this, 'up'),
      new Pump(robot, browser, this, 'down'),
    ] as const;
    this.#connections.push({ sockets: [browser, robot], pumps });
  }
}
