// Commands to the robot, one after the other; what stops does not wait for them (halts.svelte.ts).
// What it answers is shown in its own words. Where no answer comes, the page does not know whether it
// was obeyed: it says so, and asks the robot.

import type { Answer, Refusal } from '../model/answer';
import type { CircleGoal, StayGoal } from '../model/circle';
import type { SendDrive, SendThrottle } from '../model/drive';
import type { Halt } from '../model/halt';
import { CLICK_LIFE_S, outcome, type Outcome, type Wish } from '../model/outcome';
import type { LatLon } from '../model/plan';
import type { Goal, LiveLink, StartFrom, VehicleCalls } from '../model/ports';
import { say } from '../model/say';
import type { StandingPose } from '../model/site_map';
import type { Mode, StationEvent, Vehicle } from '../model/vehicle';
import type { Dialogs } from './dialogs.svelte';
import { Halts } from './halts.svelte';
import type { Live } from './live.svelte';
import type { Notices } from './notices.svelte';

/** A command that was obeyed or refused has answered by then, but for a slow link. */
const DOUBT_AFTER_MS = 1500;
const ASK_AGAIN_MS = 1000;

/** A command whose answer did not come (yet). */
export interface Doubt {
  readonly what: string;
  /** Null: the robot has not told yet. */
  readonly found: Outcome | null;
  /** What happened on the robot since. */
  readonly events: readonly StationEvent[];
}

export class Pilot {
  /** The command that waits for its answer. */
  busy = $state<string | null>(null);
  /** The last refusal and what was refused; stays until the next command. */
  refused = $state.raw<{ readonly what: string; readonly refusal: Refusal } | null>(null);
  doubt = $state.raw<Doubt | null>(null);

  readonly halts: Halts;
  /** AUTO wants a hand on the gamepad, and has none: why. */
  no_hand = $state<string | null>(null);

  readonly send_drive: SendDrive;
  readonly send_throttle: SendThrottle;
  readonly #calls: VehicleCalls;
  readonly #link: LiveLink;
  readonly #live: Live;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;

  constructor(calls: VehicleCalls, link: LiveLink, live: Live, notices: Notices, dialogs: Dialogs) {
    this.#calls = calls;
    this.#link = link;
    this.send_drive = link.send_drive;
    this.send_throttle = link.send_throttle;
    this.#live = live;
    this.#notices = notices;
    this.#dialogs = dialogs;
    this.halts = new Halts(calls, link, live);
  }

  halt = (halt: Halt): void => this.halts.press(halt);
  hold = (): void => this.halt('hold');
  disarm = (): void => this.halt('disarm');
  pause = (): void => this.halt('pause');
  stop_mission = (): void => this.halt('stop');
  /** At once and without a question. */
  estop = (): void => this.halt('estop');

  arm = (by_hand = false): Promise<boolean> =>
    this.#do(say('arm'), { to: 'arm' }, () => this.#calls.arm(by_hand));
  go_on = (): Promise<boolean> =>
    this.#do(say('go_on'), { to: 'go_on' }, () => this.#calls.go_on());
  resume = (): Promise<boolean> =>
    this.#do(say('resume'), { to: 'run' }, () => this.#calls.resume());
  skip = (): Promise<boolean> => this.#do(say('skip'), { to: 'skip' }, () => this.#calls.skip());
  go_to = (goal: Goal): Promise<boolean> =>
    this.#do(say('go_here'), { to: 'do', kinds: ['goto'] }, () => this.#calls.go_to(goal));
  dock = (goal: Goal & { readonly heading_deg: number }): Promise<boolean> =>
    this.#do(say('dock_here'), { to: 'mode', mode: 'DOCK' }, () => this.#calls.dock(goal));
  loiter = (goal: StayGoal): Promise<boolean> =>
    this.#do(say('stay_here'), { to: 'mode', mode: 'LOITER' }, () => this.#calls.loiter(goal));
  circle = (goal: CircleGoal): Promise<boolean> =>
    this.#do(say('circle_here'), { to: 'mode', mode: 'CIRCLE' }, () => this.#calls.circle(goal));
  move = (forward_m: number): Promise<boolean> =>
    this.#do(say('move'), { to: 'do', kinds: ['move'] }, () => this.#calls.move(forward_m));
  turn = (turn_deg: number): Promise<boolean> =>
    this.#do(say('turn'), { to: 'do', kinds: ['turn'] }, () => this.#calls.turn(turn_deg));
  set_home = (at: LatLon): Promise<boolean> =>
    this.#do(say('home_here'), { to: 'home', at }, () => this.#calls.set_home(at));
  stand_at = (pose: StandingPose): Promise<boolean> =>
    this.#do(say('i_am_here'), { to: 'stand', at: pose }, () => this.#calls.stand_at(pose));
  load = (id: string, revision: number): Promise<boolean> =>
    this.#do(say('load'), { to: 'load', id, revision }, () => this.#calls.load(id, revision));

  async set_mode(mode: Mode): Promise<boolean> {
    if (mode === 'HOLD') {
      this.hold();
      return true;
    }
    return this.#do(say('mode_mode', { mode }), { to: 'mode', mode }, () =>
      this.#calls.set_mode(mode),
    );
  }

  async reset_estop(): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: say('reset_the_emergency_stop'),
      text: say('the_robot_can_be_armed_and_driven'),
      yes: say('reset'),
      danger: true,
    });
    if (sure) await this.#do(say('reset'), { to: 'reset' }, () => this.#calls.reset_estop());
  }

  async acknowledge(): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: say('does_the_robot_stand_where_the_map'),
      text: say('it_set_its_position_anew_far_from'),
      yes: say('i_have_looked'),
      danger: true,
    });
    if (sure)
      await this.#do(say('i_have_looked'), { to: 'acknowledge' }, () => this.#calls.acknowledge());
  }

  async settle_shift(keep: boolean): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: keep ? say('keep_the_old_place') : say('take_the_new_place'),
      text: keep
        ? say('the_robot_stands_where_the_map_shows')
        : say('the_robot_is_moved_on_the_map_to'),
      yes: keep ? say('keep') : say('take'),
      danger: true,
    });
    if (sure)
      await this.#do(
        keep ? say('keep_the_old_place_2') : say('take_the_new_place_2'),
        { to: 'settle_shift' },
        () => this.#calls.settle_shift(keep),
      );
  }

  async correct_antennas(): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: say('are_the_two_antennas_mounted_askew'),
      text: say('what_was_measured_is_taken_from'),
      yes: say('correct_them'),
      danger: true,
    });
    if (sure)
      await this.#do(say('correct_antennas'), { to: 'correct_antennas' }, () =>
        this.#calls.correct_antennas(),
      );
  }

  /** Asks the robot what a start would do, and shows it. Nothing moves. */
  async preview(from: StartFrom): Promise<void> {
    await this.#one(say('start'), async () => {
      const answer = await this.#calls.preview(from);
      if (answer.ok) this.#dialogs.show({ kind: 'start', preview: answer.value, from });
      else this.refused = { what: say('start'), refusal: answer.refusal };
      return answer.ok;
    });
  }

  async start(id: string, revision: number, from: StartFrom): Promise<void> {
    this.#dialogs.close();
    await this.#do(say('start'), { to: 'run' }, () => this.#calls.start(id, revision, from));
  }

  /** The one in hand was pulled out, or its battery is empty. */
  gamepad_gone(): void {
    this.#notices.show('warning', say('the_gamepad_is_gone'), 'gamepad');
  }

  /** One command at a time; another one is not sent, and not in silence. */
  async #one(what: string, run: () => Promise<boolean>): Promise<boolean> {
    if (this.busy !== null) {
      this.#notices.show(
        'warning',
        say('what_was_not_sent_busy_still_waits', { what, busy: this.busy }),
      );
      return false;
    }
    this.busy = what;
    this.refused = null;
    this.doubt = null;
    try {
      return await run();
    } finally {
      this.busy = null;
    }
  }

  #do(what: string, wish: Wish, call: () => Promise<Answer<unknown>>): Promise<boolean> {
    return this.#one(what, async () => {
      const before = this.#live.vehicle;
      const seen_s = this.#link.seen_s();
      // A stop that is pressed from now on must outlast this command.
      if (seen_s !== null) this.halts.risk_until_s = seen_s + CLICK_LIFE_S;
      const waits = setTimeout(() => {
        this.doubt = { what, found: null, events: [] };
      }, DOUBT_AFTER_MS);
      const answer = await call();
      clearTimeout(waits);
      const unknown = !answer.ok && answer.refusal.status === 0;
      if (!unknown) this.halts.risk_until_s = null;
      this.doubt = unknown ? { what, found: null, events: [] } : null;
      if (unknown) void this.#ask_what_it_did(this.doubt, wish, before);
      else if (!answer.ok) this.refused = { what, refusal: answer.refusal };
      return answer.ok;
    });
  }

  /** Until the robot tells, or another command is given. */
  async #ask_what_it_did(doubt: Doubt | null, wish: Wish, before: Vehicle | null): Promise<void> {
    const given_up = (): boolean => doubt === null || this.doubt !== doubt;
    while (!given_up()) {
      const after = await this.#calls.vehicle();
      const since = before && after.ok ? await this.#calls.events_since(before.time) : null;
      if (given_up() || !doubt) return;
      if (after.ok) {
        const events = since?.ok ? since.value.items : [];
        this.doubt = { ...doubt, found: outcome(wish, before, after.value), events };
        this.halts.risk_until_s = null;
        return;
      }
      await new Promise((resolve) => setTimeout(resolve, ASK_AGAIN_MS));
    }
  }
}
