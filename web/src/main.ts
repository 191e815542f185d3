// Wires the page by hand; the only file that sees every room.

import { mount } from 'svelte';

import { access_calls } from './link/access';
import { audit_calls } from './link/audit';
import { camera_calls } from './link/cameras';
import { control_calls } from './link/control';
import { drill_calls } from './link/drill';
import { first_stop } from './link/first_stop';
import { field_calls } from './link/fields';
import { read_identity } from './link/identity';
import { me_calls } from './link/me';
import { parameter_calls } from './link/parameters';
import { people_calls } from './link/people';
import { mission_calls, vehicle_calls } from './link/rest';
import { run_calls } from './link/runs';
import { seen_calls } from './link/seen';
import { site_map_calls } from './link/site_maps';
import { known_place_calls } from './link/known_places';
import { slip_calls } from './link/slips';
import {
  camera_storage,
  kept_storage,
  ground_storage,
  layer_storage,
  settings_storage,
  view_storage,
} from './link/storage';
import { Stream } from './link/stream';
import { teach_calls } from './link/teach';
import { tile_calls } from './link/tiles';
import type { FieldMap } from './map/map';
import { invitation_in, type Account } from './model/access';
import { map_to_come, type MapToCome } from './model/map_to_come';
import type { MapCalls, StreamEvents } from './model/ports';
import App from './ui/App.svelte';
import { CameraWatch } from './ui/camera.svelte';
import { ControlDesk } from './ui/control.svelte';
import { device } from './ui/device.svelte';
import type { Doors } from './ui/doors';
import { Identity } from './ui/identity.svelte';
import { tongue } from './ui/language.svelte';
import { Station } from './ui/station.svelte';

const LOOK_MS = 10_000;
const WHO_MS = 30_000;
const KEEP_AFTER_MS = 5_000;
const FETCH_AGAIN_MS = 2_000;

const identity = new Identity();

/** Another robot may come into the network and have the name; and the first answer may be lost. */
const learn_who = async (): Promise<void> => {
  const answer = document.visibilityState === 'visible' ? await read_identity() : null;
  if (answer?.ok) identity.take(answer.value);
  setTimeout(() => void learn_who(), identity.robot ? WHO_MS : LOOK_MS);
};

const element = (id: string): HTMLElement => {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no element "${id}"`);
  return found;
};

/** As at first: whoever is not logged in any more finds the log-in. */
const again = (): void => {
  location.reload();
};

/** A robot that does not say anything: what the page can do without it comes all the same. */
const STATE_LIMIT_MS = 1500;

/** Settled once the first state of the robot is on the screen. */
const first_state = (): { readonly seen: Promise<void>; readonly take: () => void } => {
  let came = false;
  let settle = (): void => undefined;
  const seen = new Promise<void>((done) => {
    settle = done;
    setTimeout(done, STATE_LIMIT_MS);
  });
  const take = (): void => {
    if (!came) requestAnimationFrame(() => setTimeout(settle, 0));
    came = true;
  };
  return { seen, take };
};

/** Until it is there: a page that stays open longer than its network does gets it all the same. */
const fetched = async <T>(load: () => Promise<T>): Promise<T> => {
  for (;;) {
    try {
      return await load();
    } catch {
      await new Promise((done) => setTimeout(done, FETCH_AGAIN_MS));
    }
  }
};

/** In the place of what the document had there. @return where the page goes */
const cleared = (): HTMLElement => {
  const target = element('app');
  target.replaceChildren();
  return target;
};

/** The station needs a way to send before there is a stream, and the stream needs the station. */
interface Late {
  stream: Stream | null;
}

const doors = (map: MapCalls, late: Late): Doors => ({
  missions: mission_calls,
  vehicle: vehicle_calls(() => late.stream?.seen_s() ?? null),
  me: me_calls(() => late.stream?.seen_s() ?? null),
  teach: teach_calls,
  runs: run_calls,
  slips: slip_calls,
  known: known_place_calls,
  graphs: async () => (await import('./link/node_graphs')).node_graph_calls,
  seen: seen_calls,
  sites: site_map_calls,
  tiles: tile_calls,
  ground: ground_storage,
  drill: drill_calls,
  ...field_calls,
  map,
  kept: kept_storage,
  layers: layer_storage,
  link: {
    send_drive: (...wish) => late.stream?.send_drive(...wish) ?? false,
    send_throttle: (...hand) => late.stream?.send_throttle(...hand) ?? false,
    send_halt: (halt) => late.stream?.send_halt(halt) ?? false,
    seen_s: () => late.stream?.seen_s() ?? null,
    robot_s: () => late.stream?.robot_s() ?? null,
    watch: (rates) => late.stream?.watch(rates),
  },
});

/** The map, then the rest, each in a task of its own. */
const what_can_wait = (seen: Promise<void>, map: MapToCome) => {
  const field_map = seen
    .then(() => fetched(() => import('./map/map')))
    .then(({ FieldMap }) => {
      const come = new FieldMap(element('map'), view_storage);
      map.come(come);
      return come;
    });
  return { field_map, rest: field_map.then(() => fetched(() => import('./ui/rest'))) };
};

const watch_window = (station: Station, late: Late): void => {
  window.addEventListener('online', () => late.stream?.hurry());
  document.addEventListener('visibilitychange', () => {
    if (document.visibilityState === 'visible') late.stream?.hurry();
    else station.editor.write_draft();
  });
  window.addEventListener('beforeunload', (event) => {
    station.editor.write_draft();
    if (station.editor.unsaved) event.preventDefault();
  });
};

const begin = (account: Account | null, session: string | null): void => {
  const map = map_to_come();
  const late: Late = { stream: null };
  const station = new Station(doors(map.map, late));
  const desk = account && session ? new ControlDesk(control_calls, session, account.role) : null;
  const state = first_state();
  const events: StreamEvents = {
    ...station.stream_events,
    on_vehicle: (...told) => {
      station.stream_events.on_vehicle(...told);
      state.take();
    },
    ...(desk ? { on_control: desk.take_message } : {}),
  };
  late.stream = new Stream(events, again);
  const { field_map, rest } = what_can_wait(state.seen, map);
  const is_admin = account?.role === 'admin';
  const props = {
    station,
    identity,
    account,
    desk,
    audit: is_admin ? audit_calls : null,
    people: is_admin ? people_calls : null,
    parameters: parameter_calls,
    camera: new CameraWatch(camera_calls, camera_storage),
    left: again,
    watch_pointer: (moved: Parameters<FieldMap['watch_pointer']>[0]) => {
      void field_map.then((come) => come.watch_pointer(moved));
    },
    rest,
  };
  mount(App, { target: cleared(), props });
  first_stop.hand_over(() => station.pilot.estop());

  void field_map.then(() => station.grounds.refresh());
  void rest.then(() => tongue.page_is_live());
  watch_window(station, late);
};

/** Kept for where the robot is not; only on a page that can be trusted (HTTPS, or this computer). */
const keep_page = (): void => {
  const kept = import.meta.env.PROD ? navigator.serviceWorker?.register('/offline.js') : undefined;
  kept?.catch(() => undefined); // without it the page works as well, where the robot is
};

/** A robot that was started anew may not know us any more. */
const watch_log_in = (): void => {
  setInterval(() => {
    if (document.visibilityState !== 'visible') return;
    void access_calls.state().then((state) => {
      if (state.ok && state.value.access && state.value.user === null) again();
    });
  }, LOOK_MS);
};

device.open(settings_storage);
// What it fetches must not stand before what is live.
setTimeout(keep_page, KEEP_AFTER_MS);
void learn_who();
void access_calls.state().then((answer) => {
  if (!answer.ok || !answer.value.access) {
    begin(null, null);
    if (!answer.ok) watch_log_in();
    return;
  }
  const { user, role, id } = answer.value;
  const invitation = invitation_in(location.hash);
  // It is good once: neither the address bar nor the history keeps it.
  if (invitation !== null) history.replaceState(null, '', location.pathname);
  if (user === null || role === null) {
    const at_first = answer.value;
    const props = { calls: access_calls, identity, at_first, invitation, entered: again };
    void fetched(() => import('./ui/LogIn.svelte')).then(({ default: LogIn }) => {
      mount(LogIn, { target: cleared(), props });
      first_stop.hand_over(null);
    });
    return;
  }
  begin({ calls: access_calls, user, role }, id);
  watch_log_in();
});
