// The drivers of the vehicle: what the server tells of them, and how it is said to a person.

import { age, number_text } from './format';
import { say, told } from './say';

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

export const driver_state_words: Record<DriverState, string> = told({
  down: 'off',
  opening: 'opening',
  up: 'up',
  faulty: 'faulty_tries_again',
  failed: 'failed',
});

export const driver_tone = (driver: Driver): 'good' | 'warn' | 'bad' => {
  if (driver.state === 'failed' || driver.hazards.length > 0) return 'bad';
  return driver.state === 'up' ? 'good' : 'warn';
};

/** "heard 0.1 s ago · 282 Hz · restarted 2 times" */
export const driver_line = (driver: Driver): string => {
  const parts = [
    driver.age_s === null ? say('not_heard_yet') : say('heard_age_ago', { age: age(driver.age_s) }),
    number_text(driver.rate_hz, 0, 'Hz'),
  ];
  if (driver.restarts > 0) parts.push(say('restarted_times', { n: driver.restarts }));
  return parts.join(' · ');
};

/** What a person should read at once, the worst first. */
export const driver_troubles = (driver: Driver): readonly string[] => {
  const out: string[] = [...driver.hazards];
  if (driver.reason !== '') out.push(driver.reason);
  if (driver.recording === 'stopped')
    out.push(
      say('not_recorded_recording_problem', { recording_problem: driver.recording_problem }),
    );
  return out;
};

/** The rest, as pairs of name and value. */
export const driver_details = (driver: Driver): readonly (readonly [string, string])[] => {
  const out: [string, string][] = [];
  if (driver.link.address !== null) {
    out.push([
      say('link'),
      `${driver.link.address}, ${driver.link.open ? say('word_open') : say('word_closed')}`,
    ]);
  }
  for (const [name, value] of Object.entries(driver.facts)) {
    out.push([name.replaceAll('_', ' '), value]);
  }
  const rates = Object.entries(driver.rates_hz).map(
    ([message, hz]) => `${message} ${number_text(hz, 1, 'Hz')}`,
  );
  if (rates.length > 0) out.push([say('rates'), rates.join(', ')]);
  for (const [cause, times] of Object.entries(driver.counts)) out.push([cause, String(times)]);
  if (driver.recording === 'on') out.push([say('recording'), say('word_on')]);
  if (driver.last_error !== null) {
    out.push([
      say('last_error'),
      say('age_ago_detail', {
        age: age(driver.last_error.age_s),
        detail: driver.last_error.detail,
      }),
    ]);
  }
  return out;
};
