// The live stream. One socket, opened again for ever:
//
//   connecting --open--> open --closed | silent 4 s--> closed --(backoff)--> connecting
//
// An open socket that says nothing is worth no more than a closed one: the watchdog closes it, and at
// once where the robot answers otherwise. A ping every second measures the way there and back, behind
// all data that waits on the same socket.

import { Pings, RobotClock } from '../model/clock';
import {
  backoff_ms,
  PROBE_LIMIT_MS,
  should_probe,
  should_reopen,
  type LinkHealth,
  type SocketState,
} from '../model/freshness';
import type { Halt } from '../model/halt';
import type { LiveLink, StreamEvents } from '../model/ports';
import type { SeenTopic } from '../model/seen';
import { ask_anew } from './anew';
import type { components } from './schema';
import { bytes_of } from './seen';

type Schemas = components['schemas'];
type Message =
  | Schemas['StreamHello']
  | Schemas['StreamVehicle']
  | Schemas['StreamEvent']
  | Schemas['StreamMissions']
  | Schemas['StreamControl']
  | Schemas['StreamScan']
  | Schemas['StreamGrid']
  | Schemas['StreamObstacles']
  | Schemas['StreamPong']
  | Schemas['StreamStopped']
  | Schemas['StreamError'];

/** The server's close code for it. */
const LOG_IN_AGAIN = 4401;
const WATCH_MS = 250;
const PING_MS = 1000;
const TOPICS = { vehicle: 10, events: 0, missions: 0, control: 0 };
/** Bytes not yet taken by the network: a drive command behind them would come too late. */
const DRIVE_BACKLOG = 512;

const HEALTH = '/api/v1/health';

const address = (): string =>
  `${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/api/v1/stream`;

export class Stream implements LiveLink {
  readonly #events: StreamEvents;
  readonly #clock = new RobotClock();
  readonly #pings = new Pings();
  #socket: WebSocket | null = null;
  #state: SocketState = 'closed';
  #opened_ms = 0;
  #last_message_ms: number | null = null;
  #newest: {
    readonly vehicle: Schemas['Vehicle'];
    readonly mono_s: number;
    readonly came_ms: number;
  } | null = null;
  /** It will be shown. */
  #soon = false;
  /** The shown state: the robot's clock when it was sent, and when it came. */
  #shown: { readonly mono_s: number; readonly came_ms: number } | null = null;
  #attempt = 0;
  #was_open = false;
  #probing = false;
  #retry: ReturnType<typeof setTimeout> | undefined;
  #drive_seq = 0;
  /** What is looked at besides. */
  #more: Readonly<Partial<Record<SeenTopic, number>>> = {};

  /** @param logged_out the robot closed it because the log-in has ended */
  constructor(
    events: StreamEvents,
    private readonly logged_out: () => void = () => undefined,
  ) {
    this.#events = events;
    setInterval(() => this.#watch(), WATCH_MS);
    setInterval(() => this.#ping(), PING_MS);
    this.#connect();
  }

  /** Teleoperation. @return false: not connected or congested, nothing was sent */
  send_drive = (
    speed_mps: number,
    yaw_rate_dps: number,
    deadman: boolean,
    past = false,
  ): boolean => {
    const backlog = this.#socket?.bufferedAmount ?? 0;
    if (deadman && backlog > DRIVE_BACKLOG) return false;
    const seq = this.#drive_seq + 1;
    const seen_s = this.seen_s();
    const seen = seen_s === null ? {} : { seen_s };
    const over = deadman && past ? { override_guard: true } : {};
    const drive = { speed_mps, yaw_rate_dps, deadman, seq, ...seen, ...over };
    const sent = this.#send({ drive });
    if (sent) this.#drive_seq = seq;
    return sent;
  };

  /** A hand on the speed of AUTO. @return as send_drive */
  send_throttle = (share: number, held: boolean): boolean => {
    if (held && (this.#socket?.bufferedAmount ?? 0) > DRIVE_BACKLOG) return false;
    const seen_s = this.seen_s();
    const seen = seen_s === null ? {} : { seen_s };
    return this.#send({ throttle: { share, held, ...seen } });
  };

  /** Needs no free connection and waits behind nothing: the socket is open already. */
  send_halt(halt: Halt): boolean {
    return this.#send(halt === 'estop' ? { estop: true } : { halt });
  }

  /** The robot's clock when what is shown was sent, and what has passed since by our own: so the age
   * that the robot finds is the way of that message to us and the way of the command back. */
  seen_s(): number | null {
    if (this.#shown === null || this.#state !== 'open') return null;
    return this.#shown.mono_s + (performance.now() - this.#shown.came_ms) / 1000;
  }

  robot_s(): number | null {
    return this.#clock.robot_s(performance.now());
  }

  watch(rates_hz: Readonly<Partial<Record<SeenTopic, number>>>): void {
    if (JSON.stringify(rates_hz) === JSON.stringify(this.#more)) return;
    this.#more = rates_hz;
    this.#subscribe();
  }

  /** Try at once, for example when the device woke up. */
  hurry(): void {
    if (this.#socket !== null) return;
    this.#attempt = 0;
    this.#connect();
  }

  #connect(): void {
    clearTimeout(this.#retry);
    const socket = new WebSocket(address());
    this.#socket = socket;
    this.#opened_ms = performance.now();
    this.#report('connecting');
    socket.onopen = () => {
      if (this.#was_open) ask_anew();
      this.#was_open = true;
      this.#subscribe();
      this.#pings.restart();
      this.#ping();
      this.#opened_ms = performance.now();
      this.#report('open');
    };
    socket.onmessage = ({ data }) => {
      if (this.#socket === socket && typeof data === 'string') this.#take(data);
    };
    socket.onclose = ({ code }) => {
      if (code === LOG_IN_AGAIN) this.logged_out();
      if (this.#socket === socket) this.#drop();
    };
  }

  #take(text: string): void {
    const message = JSON.parse(text) as Message;
    const now_ms = performance.now();
    this.#last_message_ms = now_ms;
    this.#attempt = 0;
    this.#clock.take_message(message.mono_s, now_ms);
    switch (message.topic) {
      case 'hello':
        this.#events.on_hello(message.data.capabilities);
        break;
      case 'vehicle':
        // Drawing takes longer than reading: on a slow device states would queue up and grow old. All
        // that wait already are read first, and the newest is shown.
        this.#newest = { vehicle: message.data, mono_s: message.mono_s, came_ms: now_ms };
        if (!this.#soon) setTimeout(() => this.#show_newest(), 0);
        this.#soon = true;
        return;
      case 'pong': {
        const sent_ms = this.#pings.answer(message.data.ping, now_ms);
        if (sent_ms !== null) this.#clock.take_round_trip(sent_ms, now_ms, message.mono_s);
        break;
      }
      case 'estop':
        this.#events.on_stopped();
        break;
      case 'events':
        this.#events.on_event(message.data);
        break;
      case 'missions':
        this.#events.on_mission_changed(message.data.id, message.data.revision);
        break;
      case 'control':
        this.#events.on_control?.(message.data);
        break;
      case 'scan':
        this.#events.on_scan?.(message.data);
        break;
      case 'grid':
        this.#events.on_grid?.({ ...message.data, runs: bytes_of(message.data.runs) });
        break;
      case 'obstacles':
        this.#events.on_things?.(message.data);
        break;
      case 'error':
        this.#events.on_refused({ ...message.data, errors: message.data.errors ?? [] });
        break;
    }
    this.#report('open');
  }

  #subscribe(): void {
    this.#send({ subscribe: { ...TOPICS, ...this.#more } });
  }

  #show_newest(): void {
    this.#soon = false;
    const newest = this.#newest;
    this.#newest = null;
    if (!newest) return;
    this.#shown = newest;
    this.#events.on_vehicle(newest.vehicle, newest.mono_s);
    this.#report('open');
  }

  #send(message: object): boolean {
    if (this.#socket?.readyState !== WebSocket.OPEN) return false;
    this.#socket.send(JSON.stringify(message));
    return true;
  }

  #ping(): void {
    if (this.#socket?.readyState !== WebSocket.OPEN) return;
    const ping = this.#pings.send(performance.now());
    if (ping !== null) this.#send({ ping });
  }

  get #health(): LinkHealth {
    return {
      socket: this.#state,
      last_message_ms: this.#last_message_ms,
      true_at_ms: this.#shown && this.#clock.page_ms(this.#shown.mono_s),
      round_trip_s: this.#pings.round_trip_s,
      unanswered_since_ms: this.#pings.unanswered_since_ms,
    };
  }

  #watch(): void {
    if (!this.#socket) return;
    if (should_reopen(this.#opened_ms, this.#health, performance.now())) this.#drop();
    else this.#report(this.#state);
    if (this.#probe_is_due()) void this.#probe();
  }

  #probe_is_due(): boolean {
    return should_probe(this.#opened_ms, this.#health, performance.now());
  }

  /** The robot answers otherwise, and the socket stays silent: a new one is opened at once. */
  async #probe(): Promise<void> {
    if (this.#probing) return;
    this.#probing = true;
    const socket = this.#socket;
    const signal = AbortSignal.timeout(PROBE_LIMIT_MS);
    const answer = await fetch(HEALTH, { signal, cache: 'no-store' }).catch(() => null);
    this.#probing = false;
    if (!answer?.ok || this.#socket !== socket || !this.#probe_is_due()) return;
    this.#drop();
    this.hurry();
  }

  #drop(): void {
    const old = this.#socket;
    this.#socket = null;
    this.#newest = null;
    old?.close();
    this.#report('closed');
    clearTimeout(this.#retry);
    this.#retry = setTimeout(() => this.#connect(), backoff_ms(this.#attempt, Math.random()));
    this.#attempt += 1;
  }

  #report(state: SocketState): void {
    this.#state = state;
    this.#events.on_link(this.#health);
  }
}
