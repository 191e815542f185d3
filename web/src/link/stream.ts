// The live stream. One socket, opened again for ever:
//
//   connecting --open--> open --closed | silent 4 s--> closed --(backoff)--> connecting
//
// An open socket that says nothing is worth no more than a closed one: the watchdog closes it.

import { backoff_ms, should_reopen, type SocketState } from '../model/freshness';
import type { StreamEvents } from '../model/ports';
import type { components } from './schema';

type Schemas = components['schemas'];
type Message =
  | Schemas['StreamHello']
  | Schemas['StreamVehicle']
  | Schemas['StreamEvent']
  | Schemas['StreamMissions'];

const WATCH_MS = 500;
const SUBSCRIBE = JSON.stringify({ subscribe: { vehicle: 10, events: 0, missions: 0 } });
/** Bytes not yet taken by the network: a drive command behind them would come too late. */
const DRIVE_BACKLOG = 512;

const address = (): string =>
  `${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/api/v1/stream`;

export class Stream {
  readonly #events: StreamEvents;
  #socket: WebSocket | null = null;
  #state: SocketState = 'closed';
  #opened_ms = 0;
  #last_message_ms: number | null = null;
  #attempt = 0;
  #retry: ReturnType<typeof setTimeout> | undefined;
  #drive_seq = 0;

  constructor(events: StreamEvents) {
    this.#events = events;
    setInterval(() => this.#watch(), WATCH_MS);
    this.#connect();
  }

  /** Teleoperation. @return false: not connected or congested, nothing was sent */
  send_drive(speed_mps: number, yaw_rate_dps: number, deadman: boolean): boolean {
    const socket = this.#socket;
    if (socket?.readyState !== WebSocket.OPEN) return false;
    if (deadman && socket.bufferedAmount > DRIVE_BACKLOG) return false;
    this.#drive_seq += 1;
    const message: Schemas['StreamDrive'] = {
      drive: { speed_mps, yaw_rate_dps, deadman, seq: this.#drive_seq },
    };
    socket.send(JSON.stringify(message));
    return true;
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
      socket.send(SUBSCRIBE);
      this.#report('open');
    };
    socket.onmessage = ({ data }) => {
      if (this.#socket === socket && typeof data === 'string') this.#take(data);
    };
    socket.onclose = () => {
      if (this.#socket === socket) this.#drop();
    };
  }

  #take(text: string): void {
    const message = JSON.parse(text) as Message;
    this.#last_message_ms = performance.now();
    this.#attempt = 0;
    switch (message.topic) {
      case 'hello':
        this.#events.on_hello(message.data.capabilities);
        break;
      case 'vehicle':
        this.#events.on_vehicle(message.data);
        break;
      case 'events':
        this.#events.on_event(message.data);
        break;
      case 'missions':
        this.#events.on_mission_changed(message.data.id, message.data.revision);
        break;
    }
    this.#report('open');
  }

  #watch(): void {
    const health = { socket: this.#state, last_message_ms: this.#last_message_ms };
    if (this.#socket && should_reopen(this.#opened_ms, health, performance.now())) this.#drop();
  }

  #drop(): void {
    const old = this.#socket;
    this.#socket = null;
    old?.close();
    this.#report('closed');
    clearTimeout(this.#retry);
    this.#retry = setTimeout(() => this.#connect(), backoff_ms(this.#attempt, Math.random()));
    this.#attempt += 1;
  }

  #report(state: SocketState): void {
    this.#state = state;
    this.#events.on_link({ socket: state, last_message_ms: this.#last_message_ms });
  }
}
