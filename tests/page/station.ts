// Starts the real programs for a test and ends them again: roverd-sim and roverd, on free ports,
// with a data folder of their own. The side channel gives the true pose, which roverd never sees.

import { spawn, type ChildProcess } from 'node:child_process';
import { cpSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createSocket } from 'node:dgram';
import { connect, type Socket } from 'node:net';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { createInterface } from 'node:readline';

import { test as base } from '@playwright/test';

import { SlowLink } from './slow_link';

const ROOT = resolve(__dirname, '../..');
const BIN = process.env['ROVERD_BIN'] ?? join(ROOT, 'build/bin');
const REAL_DATA = process.env['ROVERD_REAL_DATA'] ?? resolve(ROOT, '../shared/data');
const START_LIMIT_MS = 30_000;

/** A file from the field, or null on a machine that does not have it. */
export const real_file = (name: string): string | null => {
  const path = join(REAL_DATA, name);
  return existsSync(path) ? path : null;
};

class Program {
  readonly #process: ChildProcess;
  readonly #lines: string[] = [];
  readonly #name: string;

  /** @param name one of the built programs, or the path of another one. */
  constructor(name: string, args: readonly string[]) {
    this.#name = name;
    // A base and its receivers are computers of their own: no browser takes their time. (Chromium of
    // the superuser puts itself before others; as another user this asks in vain, and is told so.)
    const prompt = name === 'roverd-sim' ? ['nice', '-n', '-15'] : [];
    const [command = '', ...rest] = [...prompt, resolve(BIN, name), ...args];
    this.#process = spawn(command, rest, { stdio: ['ignore', 'pipe', 'pipe'] });
    this.#process.on('error', (cause) => this.#lines.push(String(cause)));
    for (const stream of [this.#process.stdout, this.#process.stderr]) {
      if (stream) createInterface({ input: stream }).on('line', (line) => this.#lines.push(line));
    }
  }

  /** The first line that fits. */
  async line(pattern: RegExp): Promise<RegExpMatchArray> {
    const end = Date.now() + START_LIMIT_MS;
    while (Date.now() < end && this.#process.exitCode === null) {
      for (const line of this.#lines) {
        const match = line.match(pattern);
        if (match) return match;
      }
      await new Promise((resolve_wait) => setTimeout(resolve_wait, 20));
    }
    throw new Error(
      `${this.#name} never said ${String(pattern)}: ${this.#lines.slice(-8).join(' | ')}`,
    );
  }

  /** As a power cut does it. */
  async kill(): Promise<void> {
    const gone = new Promise((resolve_gone) => this.#process.once('exit', resolve_gone));
    this.#process.kill('SIGKILL');
    await gone;
  }

  async stop(): Promise<void> {
    if (this.#process.exitCode !== null || this.#process.signalCode !== null) return;
    const gone = new Promise((resolve_gone) => this.#process.once('exit', resolve_gone));
    this.#process.kill('SIGTERM');
    const killer = setTimeout(() => this.#process.kill('SIGKILL'), 5000);
    await gone;
    clearTimeout(killer);
  }
}

/** Where the robot really is. */
export interface Truth {
  readonly t_s: number;
  readonly lat: number;
  readonly lon: number;
  readonly heading_deg: number;
  readonly speed_mps: number;
  readonly yaw_rate_dps: number;
}

/** The simulator's side channel. */
export class SideChannel {
  readonly #socket: Socket;
  readonly track: Truth[] = [];

  constructor(address: string) {
    const [host = '', port = ''] = address.split(':');
    this.#socket = connect({ host, port: Number(port) });
    this.#socket.on('error', () => undefined);
    createInterface({ input: this.#socket }).on('line', (text) => {
      const line = JSON.parse(text) as Partial<Truth>;
      if (typeof line.lat === 'number') this.track.push(line as Truth);
    });
    this.tell({ set: { truth_hz: 20 } });
  }

  tell(message: object): void {
    this.#socket.write(`${JSON.stringify(message)}\n`);
  }

  get now(): Truth {
    const last = this.track.at(-1);
    if (!last) throw new Error('the side channel has said nothing yet');
    return last;
  }

  close(): void {
    this.#socket.destroy();
  }
}

export interface Station {
  readonly url: string;
  readonly sim: SideChannel;
  /** A call to the API that must succeed. */
  rest<T>(method: string, path: string, body?: unknown, headers?: object): Promise<T>;
}
/** One whose program can die and come back, at the same address and with the same data. */
export interface MortalStation extends Station {
  kill(): Promise<void>;
  begin_again(): Promise<void>;
  /** The data folder. */
  readonly data: string;
  /** The printed code of the first admin, with access control. */
  code(): Promise<string>;
}

const rest_of =
  (url: string): Station['rest'] =>
  async <T>(method: string, path: string, body?: unknown, headers: object = {}) => {
    const answer = await fetch(`${url}/api/v1${path}`, {
      method,
      headers: { 'Content-Type': 'application/json', ...headers },
      ...(body === undefined ? {} : { body: JSON.stringify(body) }),
    });
    const text = await answer.text();
    if (!answer.ok) throw new Error(`${method} ${path} answers ${answer.status}: ${text}`);
    return (text === '' ? null : JSON.parse(text)) as T;
  };

const config = join(ROOT, 'config/robot.toml');

const free_udp_port = (): Promise<number> =>
  new Promise((resolve_port) => {
    const socket = createSocket('udp4');
    socket.bind(0, '127.0.0.1', () => {
      const { port } = socket.address();
      socket.close(() => resolve_port(port));
    });
  });

/** A lidar and a scanner, as the simulator casts their rays and as the profile names them. */
const eyes = (port: number): string => `
[[sensor]]
kind = "vlp16"
name = "top"
z_m = 0.7
port = "udp:${port}"

[[sensor]]
kind = "lms"
name = "front"
x_m = 0.55
z_m = 0.3
rate_hz = 25
`;
const sensors = (port: number, front: string): string => `
[sense.protect]
creep_turn_radps = 0.3

[sensors.top]
kind = "velodyne"
link = "udp:${port}"
z_m = 0.7

[sensors.front]
kind = "sick"
link = "${front}"
x_m = 0.55
z_m = 0.3
rate_hz = 25
`;

/** The files of a robot that sees, in a world of its own. @return arguments for the simulator */
const with_world = (folder: string, world: object, port: number): readonly string[] => {
  const simulated = readFileSync(join(ROOT, 'config/sim/bunker.toml'), 'utf8');
  writeFileSync(join(folder, 'world.json'), JSON.stringify(world));
  writeFileSync(join(folder, 'sim.toml'), simulated + eyes(port));
  return ['--config', join(folder, 'sim.toml'), '--world', join(folder, 'world.json')];
};

/** @param front where the scanner listens. @return the profile */
const with_sensors = (folder: string, port: number, front: string): string => {
  cpSync(join(ROOT, 'config/vehicles'), join(folder, 'vehicles'), { recursive: true });
  const path = join(folder, 'robot.toml');
  writeFileSync(path, readFileSync(config, 'utf8') + sensors(port, front));
  return path;
};

export const test = base.extend<{
  /** More arguments for roverd, by test.use(). */
  more: readonly string[];
  /** The robot has sensors, and stands in this world (docs/worlds.md); null: it drives blind. */
  world: object | null;
  station: MortalStation;
  /** The way from the browser to that station: it can be slow or broken. */
  link: SlowLink;
  /** ./run --vehicle NAME, as a person starts it. */
  vehicle: (name: string) => Promise<Station>;
  /** Plays a recording, `speed` times as fast as it was recorded. @return the address */
  replay: (file: string, speed: number) => Promise<string>;
}>({
  more: [[], { option: true }],
  world: [null, { option: true }],
  station: async ({ more, world }, use) => {
    const folder = mkdtempSync(join(tmpdir(), 'roverd-page.'));
    const programs: Program[] = [];
    let sim: SideChannel | undefined;
    try {
      const bus = ['--cansock', join(folder, 'can'), '--gnss', 'tcp:0', '--control', '0'];
      const port = world ? await free_udp_port() : 0;
      const around = world ? with_world(folder, world, port) : [];
      const simulator = new Program('roverd-sim', [...bus, '--seed', '7', ...around]);
      programs.push(simulator);
      const [ready_line, can, gnss, mti, control = ''] = await simulator.line(
        /^ready can=(\S+) gnss=(\S+) mti=(\S+).* control=(\S+)/,
      );
      const front = / front=(\S+)/.exec(ready_line)?.[1] ?? '';
      const profile = world ? with_sensors(folder, port, front) : config;
      sim = new SideChannel(control);
      const links = [
        `drivers.bunker.link=${can}`,
        `drivers.gnss.link=${gnss}`,
        `drivers.mti.link=${mti}`,
      ];
      const begin = (web_port: string): Program => {
        const program = new Program('roverd', [
          ...['--config', profile, '--data', join(folder, 'data'), '--port', web_port],
          ...links.flatMap((setting) => ['--set', setting]),
          ...more,
        ]);
        programs.unshift(program);
        return program;
      };
      let roverd = begin('0');
      const ready = /^listening on (https?:\S+)/;
      const [, url = ''] = await roverd.line(ready);
      await use({
        url,
        sim,
        data: join(folder, 'data'),
        rest: rest_of(url),
        kill: () => roverd.kill(),
        code: async () => (await roverd.line(/ with the code (\S+)$/))[1] ?? '',
        begin_again: async () => {
          roverd = begin(new URL(url).port);
          await roverd.line(ready);
        },
      });
    } finally {
      sim?.close();
      for (const program of programs) await program.stop();
      rmSync(folder, { recursive: true, force: true });
    }
  },
  link: async ({ station }, use) => {
    const link = await SlowLink.to(station.url);
    await use(link);
    link.close();
  },
  // eslint-disable-next-line no-empty-pattern
  vehicle: async ({}, use) => {
    const folder = mkdtempSync(join(tmpdir(), 'roverd-page.'));
    let run: Program | undefined;
    let sim: SideChannel | undefined;
    try {
      await use(async (name) => {
        const options = ['--vehicle', name, '--data', join(folder, 'data'), '--port', '0'];
        run = new Program(join(ROOT, 'run'), options);
        const [, control = ''] = await run.line(/true pose and faults at (\S+)$/);
        sim = new SideChannel(control);
        const [, url = ''] = await run.line(/^listening on (http:\S+)/);
        return { url, sim, rest: rest_of(url) };
      });
    } finally {
      sim?.close();
      await run?.stop();
      rmSync(folder, { recursive: true, force: true });
    }
  },
  // eslint-disable-next-line no-empty-pattern
  replay: async ({}, use) => {
    const folder = mkdtempSync(join(tmpdir(), 'roverd-page.'));
    let roverd: Program | undefined;
    await use(async (file, speed) => {
      roverd = new Program('roverd', [
        ...['--config', config, '--data', join(folder, 'data'), '--port', '0'],
        ...['--replay', file, '--replay-speed', String(speed)],
      ]);
      const [, url = ''] = await roverd.line(/^listening on (http:\S+)/);
      return url;
    });
    await roverd?.stop();
    rmSync(folder, { recursive: true, force: true });
  },
});
export { expect } from '@playwright/test';
