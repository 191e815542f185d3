// The drivers of the vehicle: what the server tells of them, and how it is said to a person.

import { age, number_text } from './format';

export type DriverState = 'down' | 'opening' | 'up' | 'faulty' | 'failed';

export interface Driver {
  readonly name: string;
  readonly state: DriverState;
  /** Why it is not up; empty when up. */
  readonly reason: string;
  readonly link: { readonly address: string | null; readonly open: boolean };
  readonly rate_hz: number | null;
  /** By message. */
  readonly rates_hz: Readonly<Record<string, number | null>>;
  /** What was refused or lost, by cause. */
  readonly counts: Readonly<Record<string, number>>;
  readonly facts: Readonly<Record<string, string>>;
  /** While there is one the robot does not move. */
  readonly hazards: readonly string[];
  readonly restarts: number;
  readonly last_error: { readonly detail: string; readonly age_s: number } | null;
  readonly recording: 'off' | 'on' | 'stopped';
  readonly recording_problem: string;
  readonly age_s: number | null;
}

export const driver_state_words: Record<DriverState, string> = {
  down: 'Off',
  opening: 'Opening',
  up: 'Up',
  faulty: 'Faulty, tries again',
  failed: 'Failed',
};

export const driver_tone = (driver: Driver): 'good' | 'warn' | 'bad' => {
  if (driver.state === 'failed' || driver.hazards.length > 0) return 'bad';
  return driver.state === 'up' ? 'good' : 'warn';
};

/** "heard 0.1 s ago · 282 Hz · restarted 2 times" */
export const driver_line = (driver: Driver): string => {
  const parts = [
    driver.age_s === null ? 'not heard yet' : `heard ${age(driver.age_s)} ago`,
    number_text(driver.rate_hz, 0, 'Hz'),
  ];
  if (driver.restarts === 1) parts.push('restarted once');
  if (driver.restarts > 1) parts.push(`restarted ${driver.restarts} times`);
  return parts.join(' · ');
};

/** What a person should read at once, the worst first. */
export const driver_troubles = (driver: Driver): readonly string[] => {
  const out: string[] = [...driver.hazards];
  if (driver.reason !== '') out.push(driver.reason);
  if (driver.recording === 'stopped') out.push(`Not recorded: ${driver.recording_problem}`);
  return out;
};

/** The rest, as pairs of name and value. */
export const driver_details = (driver: Driver): readonly (readonly [string, string])[] => {
  const out: [string, string][] = [];
  if (driver.link.address !== null) {
    out.push(['Link', `${driver.link.address}, ${driver.link.open ? 'open' : 'closed'}`]);
  }
  for (const [name, value] of Object.entries(driver.facts)) {
    out.push([name.replaceAll('_', ' '), value]);
  }
  const rates = Object.entries(driver.rates_hz).map(
    ([message, hz]) => `${message} ${number_text(hz, 1, 'Hz')}`,
  );
  if (rates.length > 0) out.push(['Rates', rates.join(', ')]);
  for (const [cause, times] of Object.entries(driver.counts)) out.push([cause, String(times)]);
  if (driver.recording === 'on') out.push(['Recording', 'on']);
  if (driver.last_error !== null) {
    out.push(['Last error', `${age(driver.last_error.age_s)} ago: ${driver.last_error.detail}`]);
  }
  return out;
};
