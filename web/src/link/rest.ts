// The REST calls of the page. Types come from the OpenAPI document; that they fit the model's words
// is checked here by the compiler.

import type { Answer } from '../model/answer';
import type { Halt } from '../model/halt';
import type { Plan } from '../model/plan';
import type { MissionCalls, VehicleCalls } from '../model/ports';
import type { SpeedsSet } from '../model/route_drive';
import { body_of } from '../model/stored_plan';
import type { Remembered } from '../model/tracks';
import type { TrailPiece } from '../model/trail';
import { request, type Call } from './request';
import type { components } from './schema';

type Schemas = components['schemas'];

/** After this the page asks the robot what became of a command. Longer than any click can live. */
const COMMAND_LIMIT_MS = 5000;
/** A try to stop that has no answer makes room for the next one. */
const HALT_LIMIT_MS = 10_000;
/** A mission of 10,000 items and the way of a day take a while over a weak radio link. */
const LARGE_LIMIT_MS = 30_000;

const etag = (revision: number): string => `"rev-${revision}"`;

const draft_of = (plan: Plan): Schemas['MissionDraft'] => body_of(plan);

const mission_path = (id: string): string => `/missions/${encodeURIComponent(id)}`;

const with_mission = <T>(path: string, call: Call): Promise<Answer<T>> =>
  request<T>(path, { limit_ms: LARGE_LIMIT_MS, ...call });

export const mission_calls: MissionCalls = {
  list: (filter, cursor) => {
    const query = new URLSearchParams({ limit: '50' });
    if (filter.place === 'archive') query.set('archived', 'true');
    if (filter.place === 'deleted') query.set('deleted', 'true');
    if (filter.name !== '') query.set('name', filter.name);
    if (filter.tag !== '') query.set('tag', filter.tag);
    if (cursor !== null) query.set('cursor', cursor);
    return request<Schemas['MissionList']>(`/missions?${query}`);
  },
  read: (id) => with_mission<Schemas['Mission']>(mission_path(id), {}),
  read_revision: (id, revision) =>
    with_mission<Schemas['Mission']>(`${mission_path(id)}/revisions/${revision}`, {}),
  revisions: (id, cursor) => {
    const query = new URLSearchParams({ limit: '50' });
    if (cursor !== null) query.set('cursor', cursor);
    return request<Schemas['RevisionList']>(`${mission_path(id)}/revisions?${query}`);
  },
  revert: (id, revision, to) =>
    with_mission<Schemas['Mission']>(`${mission_path(id)}/revert`, {
      method: 'POST',
      body: { revision: to },
      headers: { 'If-Match': etag(revision) },
    }),
  create: (plan, key) =>
    with_mission<Schemas['Mission']>('/missions', {
      method: 'POST',
      body: draft_of(plan),
      ...(key === undefined ? {} : { headers: { 'Idempotency-Key': key } }),
    }),
  replace: (id, revision, plan) =>
    with_mission<Schemas['Mission']>(mission_path(id), {
      method: 'PUT',
      body: draft_of(plan),
      headers: { 'If-Match': etag(revision) },
    }),
  remove: (id, revision) =>
    request<null>(mission_path(id), {
      method: 'DELETE',
      headers: { 'If-Match': etag(revision) },
    }),
  describe: (id, revision, change) =>
    with_mission<Schemas['Mission']>(mission_path(id), {
      method: 'PATCH',
      body: change,
      headers: { 'If-Match': etag(revision) },
    }),
  copy: (id) =>
    with_mission<Schemas['Mission']>(`${mission_path(id)}/copy`, { method: 'POST', body: {} }),
  restore: (id, revision) =>
    with_mission<Schemas['Mission']>(`${mission_path(id)}/restore`, {
      method: 'POST',
      headers: { 'If-Match': etag(revision) },
    }),
  check: (id, revision) =>
    with_mission<Schemas['CheckReport']>(`${mission_path(id)}/check`, {
      method: 'POST',
      body: { revision },
    }),
  import_file: (file, { origin, rest }) => {
    const query = new URLSearchParams({ name: file.name });
    if (origin) {
      query.set('origin_lat', String(origin.lat));
      query.set('origin_lon', String(origin.lon));
    }
    if (rest) query.set('wrong', 'leave_out');
    return with_mission<Schemas['ImportResult']>(`/missions/import?${query}`, {
      method: 'POST',
      file,
    });
  },
  export_address: (id, format) =>
    `/api/v1${mission_path(id)}/export?format=${encodeURIComponent(format)}`,
  export_refusal: async (id, format) => {
    const address = `${mission_path(id)}/export?format=${encodeURIComponent(format)}`;
    const answer = await request<ArrayBuffer>(address, { as: 'bytes' });
    return answer.ok ? null : answer.refusal;
  },
};

/** The robot's own time at which the person saw the state that he acts upon; null: not known. */
export type Seen = () => number | null;

/**
 * A command that moves, arms or resumes: it says what its sender saw, at the click, so that a late
 * one is refused. It answers with a state that we also get from the stream.
 */
const commander =
  (seen: Seen) =>
  <T = unknown>(method: 'POST' | 'PUT', path: string, body: object = {}): Promise<Answer<T>> => {
    const seen_s = seen();
    return request<T>(path, {
      method,
      body,
      headers: seen_s === null ? {} : { 'Roverd-Seen': seen_s.toFixed(3) },
      limit_ms: COMMAND_LIMIT_MS,
      lane: 'command',
    });
  };

const halts: Readonly<
  Record<Halt, readonly [method: 'POST' | 'PUT', path: string, body?: object]>
> = {
  // No body to parse, no age to check: a stop is always carried out.
  estop: ['POST', '/vehicle/estop'],
  hold: ['PUT', '/vehicle/mode', { mode: 'HOLD' }],
  pause: ['POST', '/execution/pause'],
  disarm: ['POST', '/vehicle/disarm'],
  stop: ['POST', '/execution/stop'],
};

const halt: VehicleCalls['halt'] = (which, signal) => {
  const [method, path, body] = halts[which];
  return request<unknown>(path, {
    method,
    ...(body === undefined ? {} : { body }),
    limit_ms: HALT_LIMIT_MS,
    lane: 'halt',
    signal,
  });
};

const MOST_EVENT_PAGES = 20;
/** Whoever asks over a dead connection asks again. */
const EVENTS_LIMIT_MS = 6000;
const an_hour_ago = (): string => new Date(Date.now() - 3_600_000).toISOString();

/** All of them, up to a few thousand: the oldest come first, and the newest matter most. */
const events_since = async (time: string): Promise<Answer<Schemas['EventList']>> => {
  const items: Schemas['EventList']['items'] = [];
  let next = `since=${encodeURIComponent(time)}`;
  for (let pages = 0; pages < MOST_EVENT_PAGES; pages += 1) {
    const answer = await request<Schemas['EventList']>(`/events?limit=200&${next}`, {
      limit_ms: EVENTS_LIMIT_MS,
    });
    if (!answer.ok) return answer;
    items.push(...answer.value.items);
    const { next_cursor } = answer.value;
    if (next_cursor === null) break;
    next = `since=${encodeURIComponent(time)}&cursor=${encodeURIComponent(next_cursor)}`;
  }
  return { ok: true, value: { items, next_cursor: null } };
};

type Question =
  | 'vehicle'
  | 'trail'
  | 'drivers'
  | 'satellites'
  | 'checks'
  | 'preview'
  | 'mission_way'
  | 'speeds_set'
  | 'way_home'
  | 'calibration'
  | 'left_behind'
  | 'recent_events'
  | 'events_since';

/** Ages become times. */
const pieces_of = (track: Schemas['Track'], until_s: number): TrailPiece[] =>
  track.map((piece) => piece.map(([lat, lon, age_s]) => ({ lat, lon, t_s: until_s - age_s })));

const trail = async (): Promise<Answer<Remembered>> => {
  const answer = await request<Schemas['Trail']>('/vehicle/trail', { limit_ms: LARGE_LIMIT_MS });
  if (!answer.ok) return answer;
  const until_s = Date.parse(answer.value.time) / 1000;
  const estimated = pieces_of(answer.value.estimated, until_s);
  const received = pieces_of(answer.value.received, until_s);
  return { ok: true, value: { until_s, estimated, received } };
};

const figure = async (name: string): Promise<number | null> => {
  const answer = await request<Schemas['Parameter']>(`/parameters/nav.speed.${name}`);
  return answer.ok && typeof answer.value.value === 'number' ? answer.value.value : null;
};

const speeds_set = async (): Promise<SpeedsSet> => {
  const names = ['default_mps', 'min_mps', 'max_mps', 'reverse_max_mps'];
  const [default_mps, min_mps, max_mps, reverse_max_mps] = await Promise.all(names.map(figure));
  return {
    default_mps: default_mps ?? null,
    min_mps: min_mps ?? null,
    max_mps: max_mps ?? null,
    reverse_max_mps: reverse_max_mps ?? null,
  };
};

const questions: Pick<VehicleCalls, Question> = {
  vehicle: () => request<Schemas['Vehicle']>('/vehicle'),
  trail,
  drivers: () => request<Schemas['DriverList']>('/drivers'),
  calibration: () => request<Schemas['Calibration']>('/vehicle/calibration'),
  satellites: () => request<Schemas['Satellites']>('/gnss/satellites'),
  checks: () => request<Schemas['Checks']>('/vehicle/checks'),
  preview: (from) => request<Schemas['Preview']>(`/execution/preview?from=${from}`),
  mission_way: () => request<Schemas['MissionWay']>('/execution/way', { limit_ms: LARGE_LIMIT_MS }),
  speeds_set,
  way_home: (mode) => request<Schemas['WayHome']>(`/vehicle/way_home?mode=${mode}`),
  left_behind: async () => {
    const answer = await request<Schemas['Execution']>('/execution');
    return answer.ok ? { ok: true, value: answer.value.left_behind } : answer;
  },
  recent_events: () => events_since(an_hour_ago()),
  events_since,
};

/** @param seen what the person saw, by the live stream */
export const vehicle_calls = (seen: Seen): VehicleCalls => {
  const command = commander(seen);
  return {
    ...questions,
    halt,
    arm: (by_hand) => command('POST', '/vehicle/arm', by_hand ? { by_hand } : {}),
    set_mode: (mode) => command('PUT', '/vehicle/mode', { mode }),
    go_to: (goal) => command('POST', '/vehicle/goto', goal),
    dock: (goal) => command('PUT', '/vehicle/mode', { mode: 'DOCK', ...goal }),
    loiter: (goal) => command('PUT', '/vehicle/mode', { mode: 'LOITER', ...goal }),
    circle: (goal) => command('PUT', '/vehicle/mode', { mode: 'CIRCLE', ...goal }),
    move: (forward_m) => command('POST', '/vehicle/move', { forward_m }),
    turn: (turn_deg) => command('POST', '/vehicle/move', { turn_deg }),
    set_home: ({ lat, lon }) => command('PUT', '/vehicle/home', { lat, lon }),
    stand_at: (pose) => command('PUT', '/vehicle/pose', pose),
    reset_estop: () => command('POST', '/vehicle/estop/reset'),
    acknowledge: () => command('POST', '/vehicle/acknowledge'),
    calibrate: (kind) => command<Schemas['Calibration']>('POST', '/vehicle/calibration', { kind }),
    settle_calibration: (keep) =>
      command<Schemas['Calibration']>('POST', `/vehicle/calibration/${keep ? 'keep' : 'discard'}`),
    forget_calibration: () =>
      request<Schemas['Calibration']>('/vehicle/calibration', {
        method: 'DELETE',
        lane: 'command',
      }),
    correct_antennas: () => command('POST', '/vehicle/antennas-offset', { apply: true }),
    settle_shift: (keep) => command('POST', '/vehicle/base-shift', { keep }),
    restart_driver: (name) =>
      request<unknown>(`/drivers/${encodeURIComponent(name)}/restart`, {
        method: 'POST',
        body: {},
      }),
    load: (mission_id, revision) =>
      request<unknown>('/execution/load', {
        method: 'POST',
        body: { mission_id, revision },
        limit_ms: LARGE_LIMIT_MS,
        lane: 'command',
      }),
    start: (mission_id, revision, from) =>
      command<Schemas['Preview']>('POST', '/execution/start', { mission_id, revision, from }),
    go_on: () => command('POST', '/vehicle/resume'),
    resume: () => command('POST', '/execution/resume'),
    skip: () => command('POST', '/execution/skip'),
    forget_left_behind: () =>
      request<null>('/execution/left_behind', { method: 'DELETE', lane: 'command' }),
  };
};
