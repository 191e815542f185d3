// The live stream. One socket, opened again for ever:
//
//   connecting --open--> open --closed | silent 4 s--> closed --(backoff)--> connecting
//
// An open socket that says nothing is worth no more than a closed one: the watchdog closes it.

import { backoff_ms, should_reopen, type SocketState } from '../model/freshness';
import type { SendDrive, StreamEvents } from '../model/ports';
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

export interface Stream {
  readonly send_drive: SendDrive;
  /** Try at once, for example when the device woke up. */
  readonly hurry: () => void;
}

export const open_stream = (events: StreamEvents): Stream => {
  let socket: WebSocket | null = null;
  let state: SocketState = 'closed';
  let opened_ms = 0;
  let last_message_ms: number | null = null;
  let attempt = 0;
  let timer: ReturnType<typeof setTimeout> | undefined;
  let drive_seq = 0;

  const report = (next: SocketState): void => {
    state = next;
    events.on_link({ socket: state, last_message_ms });
  };

  const take = (text: string): void => {
    const message = JSON.parse(text) as Message;
    last_message_ms = performance.now();
    attempt = 0;
    switch (message.topic) {
      case 'hello':
        events.on_hello(message.data.capabilities);
        break;
      case 'vehicle':
        events.on_vehicle(message.data);
        break;
      case 'events':
        events.on_event(message.data);
        break;
      case 'missions':
        events.on_mission_changed(message.data.id, message.data.revision);
        break;
    }
    report('open');
  };

  const retry = (): void => {
    clearTimeout(timer);
    timer = setTimeout(connect, backoff_ms(attempt, Math.random()));
    attempt += 1;
  };

  const drop = (): void => {
    const old = socket;
    socket = null;
    old?.close();
    report('closed');
    retry();
  };

  const connect = (): void => {
    clearTimeout(timer);
    const mine = new WebSocket(address());
    socket = mine;
    opened_ms = performance.now();
    report('connecting');
    mine.onopen = () => {
      mine.send(SUBSCRIBE);
      report('open');
    };
    mine.onmessage = ({ data }) => {
      if (socket === mine && typeof data === 'string') take(data);
    };
    mine.onclose = () => {
      if (socket === mine) drop();
    };
  };

  setInterval(() => {
    if (socket && should_reopen(opened_ms, { socket: state, last_message_ms }, performance.now())) {
      drop();
    }
  }, WATCH_MS);
  connect();

  return {
    send_drive: (speed_mps, yaw_rate_dps, deadman) => {
      if (socket?.readyState !== WebSocket.OPEN) return false;
      if (deadman && socket.bufferedAmount > DRIVE_BACKLOG) return false;
      drive_seq += 1;
      const message: Schemas['StreamDrive'] = {
        drive: { speed_mps, yaw_rate_dps, deadman, seq: drive_seq },
      };
      socket.send(JSON.stringify(message));
      return true;
    },
    hurry: () => {
      if (socket === null) {
        attempt = 0;
        connect();
      }
    },
  };
};
