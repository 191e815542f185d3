// The whole station in one value: what the panels share, and the effects that keep the map in step.

import { untrack } from 'svelte';

import { refusal_text } from '../model/answer';
import type { GraphOnMap } from '../model/node_graph';
import type { Found } from '../model/makings';
import { activity_mark } from '../model/modes';
import { EMPTY_PLAN, spots, type LatLon } from '../model/plan';
import type { ImportedArea, MapCalls, StreamEvents } from '../model/ports';
import { field_rings } from '../model/survey';
import { robot_place, type Check } from '../model/vehicle';
import { Beneath } from './beneath.svelte';
import { Calibrator } from './calibrator.svelte';
import { device } from './device.svelte';
import { Dialogs } from './dialogs.svelte';
import type { Doors } from './doors';
import { drawn_in } from './drawn';
import { Drills, type DrillSubject } from './drill.svelte';
import type { Drawing } from './drawing.svelte';
import { hand_on_map } from './hand_on_map';
import { MapPlanner } from './map_planner.svelte';
import { Drivers } from './drivers.svelte';
import { keep_edits_in_step } from './edits_on_map.svelte';
import { Editor } from './editor.svelte';
import { Fences } from './fences.svelte';
import { Findings } from './findings.svelte';
import { Homeward, type HomeMode } from './homeward.svelte';
import { Library } from './library.svelte';
import { Live } from './live.svelte';
import { anew_question, Makings } from './makings.svelte';
import { MyPlace } from './me.svelte';
import { Measurer } from './measure.svelte';
import { Notices } from './notices.svelte';
import { PastWay } from './past_way';
import { Pilot } from './pilot.svelte';
import { LoadedRoute } from './route.svelte';
import { Resumption } from './resumption.svelte';
import { Revisions } from './revisions.svelte';
import { RowPlanner } from './rows.svelte';
import { Runs } from './runs.svelte';
import { Seen } from './seen.svelte';
import { settled } from './settled';
import { keep_site_in_step } from './site_on_map.svelte';
import { Grounds } from './grounds.svelte';
import { SiteMaps } from './site_maps.svelte';
import { KnownPlaces } from './known_places.svelte';
import { keep_places_in_step } from './places_on_map.svelte';
import { Slips } from './slips.svelte';
import { Shaping } from './shaping.svelte';
import { speaker } from './sound';
import { Sky } from './sky.svelte';
import { Standing } from './standing.svelte';
import { Starting } from './starting.svelte';
import { Surveyor } from './survey.svelte';
import { Target } from './target.svelte';
import { Teacher } from './teach.svelte';
import { whole_of } from './whole';

export type Tab = 'drive' | 'plan' | 'missions' | 'log';
/** What is shown under Missions. */
export type Shelf = 'missions' | 'runs' | 'fences' | 'maps';
/** What is pulled out in the Drive panel. */
export type Drawer = 'move' | 'teach' | 'calibrate' | null;

export class Station {
  tab = $state<Tab>('drive');
  follow = $state(true);
  /** On a small screen the sheet can be folded away. */
  sheet_open = $state(true);
  drawer = $state<Drawer>(null);
  shelf = $state<Shelf>('missions');
  checks = $state.raw<readonly Check[]>([]);
  /** There is room for the panel beside the map. */
  wide = $state(false);

  /** What a hand on the map changes instead of the mission. */
  drawing = $derived.by<Drawing | null>(() => drawn_in(this));

  /** On what a drill would be played: the loaded mission, else the one in the editor as it is
   * stored. */
  drill_subject = $derived.by<DrillSubject | null>(() => {
    const { id, revision, name } = this.live.vehicle?.mission ?? {};
    if (id && typeof revision === 'number') {
      const plan = this.route.plan ?? EMPTY_PLAN;
      return { id, revision, name: name ?? '', plan, loaded: true };
    }
    const { stored, plan, unsaved } = this.editor;
    if (!stored || unsaved) return null;
    return { id: stored.id, revision: stored.revision, name: plan.name, plan, loaded: false };
  });

  /** A press on the map shows where the robot stands. */
  pointing = $derived.by<boolean>(() => this.tab === 'drive' && this.standing.open);
  /** The map goes with the robot now. One that moves under the finger cannot be drawn on. */
  follows = $derived.by<boolean>(
    () => this.follow && this.tab !== 'plan' && this.drawing === null && !this.pointing,
  );

  /** Once the robot drives, what it is driven with goes before. */
  drilling = $derived.by<boolean>(
    () => this.drills.open && this.live.vehicle?.mission.state !== 'running',
  );

  readonly live = new Live();
  readonly target = new Target(this.live);
  readonly notices = new Notices();
  readonly dialogs = new Dialogs();
  readonly editor: Editor;
  readonly shaping: Shaping;
  readonly beneath: Beneath;
  readonly revisions: Revisions;
  readonly library: Library;
  readonly pilot: Pilot;
  readonly drivers: Drivers;
  readonly sky: Sky;
  readonly teacher: Teacher;
  readonly runs: Runs;
  readonly slips: Slips;
  readonly known: KnownPlaces;
  readonly node_graphs: Doors['graphs'];
  /** The route graph whose card is open; null: none is. */
  graph_on_map = $state.raw<GraphOnMap | null>(null);
  readonly seen: Seen;
  readonly sites: SiteMaps;
  readonly in_map: MapPlanner;
  readonly grounds: Grounds;
  readonly standing: Standing;
  readonly me: MyPlace;
  readonly drills: Drills;
  readonly makings: Makings;
  readonly surveyor: Surveyor;
  readonly rower: RowPlanner;
  readonly measurer = new Measurer();
  readonly fences: Fences;
  readonly homeward: Homeward;
  readonly starting: Starting;
  readonly route: LoadedRoute;
  readonly calibrator: Calibrator;
  readonly resumption: Resumption;
  readonly findings: Findings;
  readonly map: MapCalls;
  readonly #doors: Doors;
  readonly #past_way: PastWay;

  constructor(doors: Doors) {
    this.#doors = doors;
    this.map = doors.map;
    this.editor = new Editor(doors.missions, doors.kept, this.notices, this.dialogs);
    this.shaping = new Shaping(this.editor);
    this.beneath = new Beneath(doors.missions, this.notices);
    this.revisions = new Revisions(doors.missions, this.editor, this.notices);
    this.library = new Library(
      doors.missions,
      this.editor,
      this.notices,
      this.dialogs,
      () => this.live.vehicle?.home ?? robot_place(this.live.vehicle),
    );
    this.pilot = new Pilot(doors.vehicle, doors.link, this.live, this.notices, this.dialogs);
    this.me = new MyPlace(doors.me, this.live, this.pilot);
    this.drivers = new Drivers(doors.vehicle, this.notices, this.dialogs);
    this.sky = new Sky(doors.vehicle);
    this.runs = new Runs(doors.runs);
    this.slips = new Slips(doors.slips, this.dialogs);
    this.known = new KnownPlaces(doors.known, this.dialogs);
    this.seen = new Seen(doors.seen, doors.link, this.live, doors.layers);
    this.grounds = new Grounds(doors.tiles, doors.ground, this.notices, this.dialogs);
    this.sites = new SiteMaps(doors.sites, this.live, this.notices, this.dialogs);
    this.in_map = new MapPlanner(this.editor, this.sites);
    this.node_graphs = doors.graphs;
    this.standing = new Standing(this.live, this.pilot);
    this.drills = new Drills(doors.drill);
    this.makings = new Makings(doors.kept.makings, this.editor);
    this.surveyor = new Surveyor(doors.survey, this.editor, this.notices, this.makings);
    this.rower = new RowPlanner(doors.rows, this.editor, this.notices, this.makings, this.live);
    this.fences = new Fences(doors.fences, this.notices, this.dialogs);
    this.homeward = new Homeward(doors.vehicle, this.live);
    this.starting = new Starting(doors.vehicle, this.live, this.dialogs);
    this.route = new LoadedRoute(doors.missions, doors.vehicle, this.notices);
    this.calibrator = new Calibrator(doors.vehicle, this.dialogs);
    this.resumption = new Resumption(doors.vehicle, this.pilot, this.notices, this.dialogs);
    this.findings = new Findings(doors.missions);
    this.teacher = new Teacher(doors.teach, this.editor, this.notices, this.dialogs);
    this.#past_way = new PastWay(doors.vehicle, this.live, doors.map);
    doors.map.listen(hand_on_map(this));
    if (this.editor.restore_draft()) this.map.fit(spots(this.editor.plan));
    void this.#fetch_past_events(null);
    $effect.root(() => this.#keep_map_in_step());
  }

  readonly stream_events: StreamEvents = {
    on_link: (link) => {
      const was_open = this.live.link.socket === 'open';
      this.live.take_link(link);
      if (link.socket !== 'open' || was_open) return;
      void this.#fetch_past_events(this.live.vehicle ? this.notices.looked : null);
      this.resumption.connected();
      void this.editor.save_again();
      this.#past_way.connected();
    },
    on_hello: (capabilities) => {
      this.live.capabilities = capabilities;
      this.map.set_size(capabilities.size.length_m, capabilities.size.width_m);
    },
    on_vehicle: (vehicle, mono_s) => {
      const robot = this.live.take(vehicle);
      if (robot) this.map.show_robot(robot, this.live.tracks);
      this.standing.take(vehicle);
      this.pilot.halts.on_vehicle(vehicle, mono_s);
      this.findings.take(vehicle);
      void this.#past_way.complete();
      if (this.route.take(vehicle)) void this.resumption.refresh();
    },
    on_refused: (refusal) => this.live.refuse_stick(refusal_text(refusal)),
    on_stopped: () => this.pilot.halts.on_stopped(),
    on_event: (event) => {
      if (this.notices.event(event)) speaker.tell(event, device.settings.cues);
      this.seen.on_event(event.kind);
      if (event.kind.endsWith('parameter')) void this.route.read_speeds();
    },
    on_grid: (grid) => this.seen.stream_events.on_grid?.(grid),
    on_scan: (scan) => this.seen.stream_events.on_scan?.(scan),
    on_things: (things) => this.seen.stream_events.on_things?.(things),
    on_mission_changed: (id, revision) => {
      void this.editor.stored_changed(id, revision);
      if (this.tab === 'missions') void this.library.refresh();
    },
  };

  choose_tab(tab: Tab): void {
    const again = this.tab === tab;
    this.sheet_open = again && !this.wide ? !this.sheet_open : true;
    this.tab = tab;
    if (tab === 'missions') void this.library.refresh();
    if (tab === 'log') void this.fetch_checks();
  }

  toggle_drawer(drawer: NonNullable<Drawer>): void {
    this.drawer = this.drawer === drawer ? null : drawer;
  }

  set_follow(follow: boolean): void {
    this.follow = follow;
    if (follow) this.map.center_robot();
  }

  /** A field of a file, as if it had been drawn. */
  cover(area: ImportedArea): void {
    const rings = field_rings(area);
    this.surveyor.name = area.name;
    this.surveyor.begin(rings);
    this.surveyor.open = true;
    this.tab = 'plan';
    this.set_follow(false);
    this.map.fit(rings[0] ?? []);
  }

  /** What the mission in the editor was made of is drawn again, to be changed. */
  async change_drawn({ drawn, by_hand }: Found): Promise<void> {
    const id = this.editor.stored?.id;
    if (id === undefined) return;
    if (by_hand && !(await this.dialogs.ask(anew_question()))) return;
    if (drawn.kind === 'survey') this.surveyor.change(id, drawn.wish);
    else this.rower.change(id, drawn);
    const places = drawn.kind === 'survey' ? drawn.wish.polygon : drawn.places;
    this.set_follow(false);
    if (places.length > 1) this.map.fit(places);
  }

  /** Shows what a report tells of, or the edited mission, or the loaded one, or the way so far. */
  fit(): void {
    const all = whole_of(this);
    if (all.length === 0) return;
    this.set_follow(false);
    this.map.fit(all);
  }

  /** Opens an item of the edited mission. @param item from 1 */
  show_item(item: number): void {
    this.dialogs.close();
    this.editor.selected = item - 1;
    this.tab = 'plan';
  }

  /** Places that an open dialog tells of. */
  see_told(places: readonly LatLon[]): void {
    this.set_follow(false);
    this.map.fit(places);
  }

  /** Straight to where it can be seen what it would do. */
  async show_way_home(mode: HomeMode): Promise<void> {
    this.dialogs.close();
    this.tab = 'drive';
    this.sheet_open = true;
    await this.homeward.show(mode);
    await this.#see(this.homeward.way?.line ?? []);
  }

  async #see(places: readonly LatLon[]): Promise<void> {
    await settled();
    if (places.length < 2) return;
    this.set_follow(false);
    this.map.fit(places);
  }

  /** Arms; what the check has found about the loaded mission is seen before. */
  arm(): void {
    const { report, name } = this.findings;
    if (report && report.findings.length > 0) {
      this.dialogs.show({ kind: 'arm', name: name ?? '', report });
    } else void this.pilot.arm();
  }

  async fetch_checks(): Promise<void> {
    const answer = await this.#doors.vehicle.checks();
    this.checks = answer.ok ? answer.value.checks : [];
  }

  /** More than once: the browser may ask over a connection that has died with the stream's. */
  async #fetch_past_events(missed_since: string | null): Promise<void> {
    for (let tries = 0; tries < 6; tries += 1) {
      const answer = await this.#doors.vehicle.recent_events();
      if (answer.ok) return this.notices.past_events(answer.value.items, missed_since);
    }
  }

  #keep_map_in_step(): void {
    const { editor, live, map } = this;
    $effect(() => map.set_follow(this.follows));
    $effect(() => {
      // What is only seen before it is done cannot be taken yet.
      const edits = this.tab === 'plan' && !this.shaping.transform ? editor.map_mode : 'watch';
      map.set_mode(this.pointing ? 'point' : (this.drawing?.map_mode ?? edits));
    });
    // A run is looked at, and a field drawn, without what is planned otherwise.
    const looks_back = $derived(this.tab === 'missions' && this.shelf === 'runs');
    $effect(() => {
      const { drawing } = this;
      const planned = [this.surveyor, this.rower].find(({ outline }) => outline === drawing);
      map.show_runs(looks_back ? this.runs.on_map : (planned?.on_map ?? []));
    });
    $effect(() => map.show_heat(looks_back ? this.runs.heat : null));
    keep_edits_in_step(
      this,
      () => looks_back && (this.runs.first !== null || this.runs.heat !== null),
    );
    $effect(() => {
      const drawn = this.drawing === this.fences ? this.fences.draft : null;
      map.show_fence(drawn ?? this.fences.active);
    });
    // Another one holds now, or none: whoever changed it.
    const fence_name = $derived(live.vehicle?.fence?.name ?? null);
    $effect(() => {
      void fence_name;
      untrack(() => void this.fences.refresh_active());
    });
    $effect(() =>
      map.show_drill(this.tab === 'drive' && this.drilling ? this.drills.on_map : null),
    );
    const current_item = $derived(live.vehicle?.mission.current_item ?? 0);
    $effect(() => map.show_route({ ...this.route.laid, current_item }));
    keep_places_in_step(this);
    keep_site_in_step(this);
    this.starting.keep_in_sight((places) => this.#see([...places, ...this.route.way]));
    $effect(() => this.seen.follow_layers());
    $effect(() => map.show_seen(this.seen.on_map));
    $effect(() => map.show_ahead(this.seen.ahead));
    $effect(() => map.show_space(this.calibrator.space));
    $effect(() => map.show_robot(live.robot, live.tracks));
    $effect(() => map.show_home(live.vehicle?.home ?? null));
    $effect(() => {
      const drives = this.tab === 'drive';
      const pin = drives ? (this.standing.mark ?? this.starting.mark ?? this.target.mark) : null;
      const home = drives ? (this.starting.home_mark ?? this.homeward.mark) : null;
      map.show_marks(pin, home ?? activity_mark(live.vehicle), this.me.on_map);
    });
  }
}
