// The checks before arming as lights, each that is not well with its cure: what a person can do, or a
// button that does it.

import { type PlainKey, say_plain, told } from './say';
import type { Check } from './vehicle';

export type Light = 'good' | 'warn' | 'bad';
/** What a button of the page can do about it. */
export type Deed = 'reset_stop' | 'acknowledge' | 'manual' | 'devices' | 'missions';
export interface Cure {
  readonly words: string;
  readonly deed: Deed | null;
}

const cure = (words: PlainKey, deed: Deed | null = null): Cure => ({
  get words() {
    return say_plain(words);
  },
  deed,
});
const cures: Readonly<Record<string, Cure>> = {
  gnss_fix: cure('let_the_antenna_see_the_open_sky_and', 'devices'),
  position_accuracy: cure('wait_or_drive_out_from_under_trees', 'manual'),
  heading: cure('drive_three_metres_straight_ahead_by', 'manual'),
  estimate: cure('look_whether_it_stands_where_the_map', 'acknowledge'),
  base_link: cure('switch_the_vehicle_on_and_look_at', 'devices'),
  base_state: cure('release_the_stop_buttons_at_the'),
  radio: cure('switch_the_transmitter_on_and_its'),
  battery: cure('charge_the_battery_or_put_in_a_full'),
  estop: cure('when_the_area_around_it_is_clear', 'reset_stop'),
  self_test: cure('do_not_drive_restart_the_program_on'),
  driver_hazard: cure('restart_the_device_that_is_down', 'devices'),
  drivers: cure('restart_the_device_that_is_down_or', 'devices'),
  sensors: cure('clean_the_sensors_and_look_at_their', 'devices'),
  computer: cure('let_it_cool_or_make_room_on_its_disk'),
  mission: cure('load_a_mission_if_it_shall_drive_by', 'missions'),
};

export interface CheckLight {
  readonly id: string;
  readonly light: Light;
  readonly detail: string;
  /** Null: it is well, or nobody knows. */
  readonly cure: Cure | null;
}

/** What is told of the computer has many causes; two of them a person in the field can mend. */
const cure_of = ({ id, detail }: Check): Cure | null =>
  id === 'computer' && !/disk|loop/.test(detail) ? null : (cures[id] ?? null);

const light_of = ({ ok, severity }: Check): Light =>
  ok || severity === 'info' ? 'good' : severity === 'warning' ? 'warn' : 'bad';
const ORDER: readonly Light[] = ['bad', 'warn', 'good'];

/** What keeps it from arming first. */
export const lights_of = (checks: readonly Check[]): readonly CheckLight[] =>
  checks
    .map((check) => ({
      id: check.id,
      light: light_of(check),
      detail: check.detail,
      cure: check.ok ? null : cure_of(check),
    }))
    .sort((a, b) => ORDER.indexOf(a.light) - ORDER.indexOf(b.light));

export const deed_words: Readonly<Record<Deed, string>> = told({
  reset_stop: 'reset_stop',
  acknowledge: 'i_have_looked',
  manual: 'drive_by_hand',
  devices: 'show_devices',
  missions: 'show_missions',
});
