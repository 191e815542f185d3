// A field that is drawn, the tracks that would cover it, and the mission that they become.

import type { Drawn } from '../model/makings';
import { spots } from '../model/plan';
import type { LineOnMap } from '../model/on_map';
import type { Places } from '../model/outline';
import type { PlanningCalls } from '../model/ports';
import type { RunOnMap } from '../model/run_ports';
import { say } from '../model/say';
import { why_not_survey, type Pattern, type Survey, type SurveyWish } from '../model/survey';
import { Outline } from './drawing.svelte';
import type { Editor } from './editor.svelte';
import type { Makings } from './makings.svelte';
import type { Notices } from './notices.svelte';
import { Planner } from './planner.svelte';

export class Surveyor extends Planner<SurveyWish, Survey> {
  spacing_m = $state(1);
  direction_deg = $state<number | null>(null);
  turn = $state<'pivot' | 'arc'>('pivot');
  radius_m = $state(2);
  headland_passes = $state(1);
  speed_mps = $state<number | null>(null);
  pattern = $state<Pattern>('tracks');
  /** The field, and the obstacles inside of it. */
  rings = $state.raw<readonly Outline[]>([new Outline()]);
  /** Which of them the hand on the map changes. */
  ring = $state(0);
  readonly outline = $derived<Outline>(this.rings[this.ring] ?? this.#field());

  wish = $derived<SurveyWish>({
    polygon: this.#field().places,
    holes: this.rings.slice(1).map(({ places }) => places),
    pattern: this.pattern,
    spacing_m: this.spacing_m,
    direction_deg: this.direction_deg,
    turn: this.turn,
    radius_m: this.radius_m,
    headland_passes: this.headland_passes,
    speed_mps: this.speed_mps,
  });
  why_not = $derived(why_not_survey(this.wish));
  on_map = $derived<readonly RunOnMap[]>(
    this.result ? [{ lines: [spots(this.result.plan)], planned: [] }] : [],
  );

  /** The rings that are not being drawn. */
  others = $derived<readonly LineOnMap[]>(
    this.rings
      .filter((each, k) => k !== this.ring && each.places.length > 1)
      .map(({ places }) => ({ places: [...places, ...places.slice(0, 1)], tone: 'other' })),
  );

  constructor(
    calls: PlanningCalls<SurveyWish, Survey>,
    editor: Editor,
    notices: Notices,
    makings: Makings,
  ) {
    super(calls, editor, notices, makings);
    this.name = say('field');
  }

  #field(): Outline {
    return this.rings[0] ?? new Outline();
  }

  /** @param rings the field and its holes */
  begin(rings: readonly Places[]): void {
    this.rings = (rings.length > 0 ? rings : [[]]).map((places) => {
      const outline = new Outline();
      outline.begin(places);
      return outline;
    });
    this.ring = 0;
  }

  add_obstacle(): void {
    this.rings = [...this.rings, new Outline()];
    this.ring = this.rings.length - 1;
  }

  remove_obstacle(): void {
    this.rings = this.rings.filter((_, k) => k !== this.ring);
    this.ring = 0;
  }

  /** A field that is a mission already. @param id of the mission */
  change(id: string, wish: SurveyWish): void {
    this.begin([wish.polygon, ...wish.holes]);
    this.pattern = wish.pattern;
    this.spacing_m = wish.spacing_m;
    this.direction_deg = wish.direction_deg;
    this.turn = wish.turn;
    this.radius_m = wish.radius_m;
    this.headland_passes = wish.headland_passes;
    this.speed_mps = wish.speed_mps;
    this.take_up(id);
  }

  protected drawn_now(): Drawn {
    return { kind: 'survey', wish: this.wish };
  }

  protected clear(): void {
    this.begin([]);
  }
}
