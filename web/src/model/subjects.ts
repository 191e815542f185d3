// What the robot's stable words are called: it sends them for machines, and a sentence in English for
// people.

import { told } from './say';

const subjects: Readonly<Record<string, string>> = told({
  gnss_fix: 'check_gnss_fix',
  position_accuracy: 'check_position_accuracy',
  heading: 'check_heading',
  estimate: 'check_estimate',
  base_link: 'check_base_link',
  base_state: 'check_base_state',
  radio: 'check_radio',
  battery: 'check_battery',
  estop: 'check_estop',
  self_test: 'check_self_test',
  driver_hazard: 'check_driver_hazard',
  drivers: 'check_drivers',
  sensors: 'check_sensors',
  computer: 'check_computer',
  mission: 'check_mission',
});
/** What a check is about: "gnss_fix" → "GNSS fix:". One that this page does not know is as it came. */
export const check_subject = (id: string): string => {
  const known = subjects[id];
  if (known !== undefined) return known;
  const words = id.replaceAll('_', ' ').replace('gnss', 'GNSS').replace('rtk', 'RTK');
  return `${words.charAt(0).toUpperCase()}${words.slice(1)}:`;
};
