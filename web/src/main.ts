// Wires the page by hand; the only file that sees every room.

import { mount } from 'svelte';

import { access_calls } from './link/access';
import { audit_calls } from './link/audit';
import { control_calls } from './link/control';
import { drill_calls } from './link/drill';
import { fence_calls, survey_calls } from './link/fields';
import { read_identity } from './link/identity';
import { parameter_calls } from './link/parameters';
import { mission_calls, tile_sets, vehicle_calls } from './link/rest';
import { run_calls } from './link/runs';
import { seen_calls } from './link/seen';
import { site_map_calls } from './link/site_maps';
import { slip_calls } from './link/slips';
import { draft_storage, layer_storage, settings_storage, view_storage } from './link/storage';
import { Stream } from './link/stream';
import { teach_calls } from './link/teach';
import { FieldMap } from './map/map';
import { invitation_in, type Account } from './model/access';
import App from './ui/App.svelte';
import { ControlDesk } from './ui/control.svelte';
import { device } from './ui/device.svelte';
import { Identity } from './ui/identity.svelte';
import LogIn from './ui/LogIn.svelte';
import { Station } from './ui/station.svelte';
import './ui/style.css';

const LOOK_MS = 10_000;
const WHO_MS = 30_000;
const KEEP_AFTER_MS = 5_000;

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

const begin = (account: Account | null, session: string | null): void => {
  const map = new FieldMap(element('map'), view_storage);
  /** The station needs a way to send before there is a stream, and the stream needs the station. */
  const late: { stream: Stream | null } = { stream: null };
  const station = new Station({
    missions: mission_calls,
    vehicle: vehicle_calls(() => late.stream?.seen_s() ?? null),
    teach: teach_calls,
    runs: run_calls,
    slips: slip_calls,
    seen: seen_calls,
    sites: site_map_calls,
    drill: drill_calls,
    survey: survey_calls,
    fences: fence_calls,
    map,
    storage: draft_storage,
    layers: layer_storage,
    link: {
      send_drive: (...wish) => late.stream?.send_drive(...wish) ?? false,
      send_halt: (halt) => late.stream?.send_halt(halt) ?? false,
      seen_s: () => late.stream?.seen_s() ?? null,
      robot_s: () => late.stream?.robot_s() ?? null,
      watch: (rates) => late.stream?.watch(rates),
    },
  });
  const desk = account && session ? new ControlDesk(control_calls, session, account.role) : null;
  const events = desk
    ? { ...station.stream_events, on_control: desk.take_message }
    : station.stream_events;
  late.stream = new Stream(events, again);
  const audit = account?.role === 'admin' ? audit_calls : null;
  const props = {
    station,
    identity,
    account,
    desk,
    audit,
    parameters: parameter_calls,
    left: again,
    watch_pointer: map.watch_pointer.bind(map),
  };
  mount(App, { target: element('app'), props });

  void tile_sets().then((sets) => map.use_tiles(sets[0] ?? null));
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
    mount(LogIn, {
      target: element('app'),
      props: { calls: access_calls, identity, at_first: answer.value, invitation, entered: again },
    });
    return;
  }
  begin({ calls: access_calls, user, role }, id);
  watch_log_in();
});
