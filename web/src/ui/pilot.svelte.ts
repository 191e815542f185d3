// Commands to the robot. What it answers is shown in its own words; the emergency stop is repeated
// until the robot has confirmed it.

import type { Answer, Refusal } from '../model/answer';
import type { LatLon } from '../model/plan';
import type { Goal, SendDrive, StartFrom, VehicleCalls } from '../model/ports';
import type { Dialogs } from './dialogs.svelte';
import type { Live } from './live.svelte';
import type { Notices } from './notices.svelte';

const STOP_TRIES = 20;
const STOP_PAUSE_MS = 250;

export class Pilot {
  /** The command that waits for its answer. */
  busy = $state<string | null>(null);
  /** The last refusal and what was refused; stays until the next command. */
  refused = $state.raw<{ readonly what: string; readonly refusal: Refusal } | null>(null);
  stopping = $state(false);

  readonly send_drive: SendDrive;
  readonly #calls: VehicleCalls;
  readonly #live: Live;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;

  constructor(
    calls: VehicleCalls,
    send_drive: SendDrive,
    live: Live,
    notices: Notices,
    dialogs: Dialogs,
  ) {
    this.#calls = calls;
    this.send_drive = send_drive;
    this.#live = live;
    this.#notices = notices;
    this.#dialogs = dialogs;
  }

  arm = (): Promise<boolean> => this.#do('Arm', () => this.#calls.arm());
  disarm = (): Promise<boolean> => this.#do('Disarm', () => this.#calls.disarm());
  pause = (): Promise<boolean> => this.#do('Pause', () => this.#calls.pause());
  resume = (): Promise<boolean> => this.#do('Resume', () => this.#calls.resume());
  stop_mission = (): Promise<boolean> => this.#do('Stop mission', () => this.#calls.stop());
  skip = (): Promise<boolean> => this.#do('Skip', () => this.#calls.skip());
  set_mode = (mode: string): Promise<boolean> =>
    this.#do(`Mode ${mode}`, () => this.#calls.set_mode(mode));
  go_to = (goal: Goal): Promise<boolean> => this.#do('Go here', () => this.#calls.go_to(goal));
  dock = (goal: Goal & { readonly heading_deg: number }): Promise<boolean> =>
    this.#do('Dock here', () => this.#calls.dock(goal));
  move = (forward_m: number): Promise<boolean> =>
    this.#do('Move', () => this.#calls.move(forward_m));
  turn = (turn_deg: number): Promise<boolean> => this.#do('Turn', () => this.#calls.turn(turn_deg));
  set_home = (at: LatLon): Promise<boolean> =>
    this.#do('Home here', () => this.#calls.set_home(at));
  load = (id: string, revision: number): Promise<boolean> =>
    this.#do('Load', () => this.#calls.load(id, revision));

  async reset_estop(): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: 'Reset the emergency stop?',
      text: 'The robot can be armed and driven again. Is the area around it clear?',
      yes: 'Reset',
      danger: true,
    });
    if (sure) await this.#do('Reset', () => this.#calls.reset_estop());
  }

  /** Asks the robot what a start would do, and shows it. Nothing moves. */
  async preview(from: StartFrom): Promise<void> {
    await this.#do('Start', async () => {
      const answer = await this.#calls.preview(from);
      if (answer.ok) this.#dialogs.show({ kind: 'start', preview: answer.value, from });
      return answer;
    });
  }

  async start(id: string, revision: number, from: StartFrom): Promise<void> {
    this.#dialogs.close();
    await this.#do('Start', () => this.#calls.start(id, revision, from));
  }

  /** At once and without a question. Every press sends; one loop repeats until it is confirmed. */
  async estop(): Promise<void> {
    this.send_drive(0, 0, false);
    if (this.stopping) {
      void this.#calls.estop();
      return;
    }
    this.stopping = true;
    for (let attempt = 0; attempt < STOP_TRIES; attempt += 1) {
      const answer = await this.#calls.estop();
      const confirmed = this.#live.vehicle?.estop === true && !this.#live.stale;
      if (answer.ok || confirmed) {
        this.stopping = false;
        return;
      }
      await new Promise((resolve) => setTimeout(resolve, STOP_PAUSE_MS));
    }
    this.stopping = false;
    this.#notices.show(
      'error',
      'STOP was not confirmed by the robot. Use the button on the robot or the radio.',
    );
  }

  async #do(what: string, call: () => Promise<Answer<unknown>>): Promise<boolean> {
    if (this.busy !== null) return false;
    this.busy = what;
    this.refused = null;
    const answer = await call();
    this.busy = null;
    if (!answer.ok) this.refused = { what, refusal: answer.refusal };
    return answer.ok;
  }
}
