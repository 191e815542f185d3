// The whole station in one value: what the panels share, and the effects that keep the map in step.

import { tick, untrack } from 'svelte';

import { refusal_text } from '../model/answer';
import { activity_mark } from '../model/modes';
import { EMPTY_PLAN, spots } from '../model/plan';
import type {
  DraftStorage,
  DrillCalls,
  FenceCalls,
  ImportedArea,
  LiveLink,
  MapCalls,
  MapEvents,
  MissionCalls,
  RunCalls,
  StreamEvents,
  SurveyCalls,
  TeachCalls,
  VehicleCalls,
} from '../model/ports';
import type { SeenCalls } from '../model/seen';
import type { SiteMapCalls } from '../model/site_map';
import type { SlipCalls } from '../model/slips';
import { field_places } from '../model/survey';
import { robot_place, type Check } from '../model/vehicle';
import { Calibrator } from './calibrator.svelte';
import { Dialogs } from './dialogs.svelte';
import { Drills, type DrillSubject } from './drill.svelte';
import type { Drawing } from './drawing.svelte';
import { Drivers } from './drivers.svelte';
import { Editor } from './editor.svelte';
import { Fences } from './fences.svelte';
import { Findings } from './findings.svelte';
import { Homeward, type HomeMode } from './homeward.svelte';
import { Library } from './library.svelte';
import { Live } from './live.svelte';
import { Notices } from './notices.svelte';
import { PastWay } from './past_way';
import { Pilot } from './pilot.svelte';
import { LoadedRoute } from './route.svelte';
import { Resumption } from './resumption.svelte';
import { Runs } from './runs.svelte';
import { Seen } from './seen.svelte';
import { SiteMaps } from './site_maps.svelte';
import { Slips } from './slips.svelte';
import { Sky } from './sky.svelte';
import { Standing } from './standing.svelte';
import { Surveyor } from './survey.svelte';
import { Target } from './target.svelte';
import { Teacher } from './teach.svelte';

const NOTHING: ReadonlySet<number> = new Set();

export type Tab = 'drive' | 'plan' | 'missions' | 'log';
/** What is shown under Missions. */
export type Shelf = 'missions' | 'runs' | 'fences' | 'maps';
/** What is pulled out in the Drive panel. */
export type Drawer = 'move' | 'teach' | 'calibrate' | null;

/** What main.ts hands in: the doors to the server, the map and the device. */
export interface Doors {
  readonly missions: MissionCalls;
  readonly vehicle: VehicleCalls;
  readonly teach: TeachCalls;
  readonly runs: RunCalls;
  readonly slips: SlipCalls;
  readonly seen: SeenCalls;
  readonly sites: SiteMapCalls;
  readonly drill: DrillCalls;
  readonly survey: SurveyCalls;
  readonly fences: FenceCalls;
  readonly map: MapCalls;
  readonly storage: DraftStorage;
  readonly layers: DraftStorage;
  readonly link: LiveLink;
}

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
  drawing = $derived.by<Drawing | null>(() => {
    if (this.tab === 'plan' && this.surveyor.open) return this.surveyor.outline;
    if (this.tab !== 'missions') return null;
    if (this.shelf === 'fences') return this.fences.draft ? this.fences : null;
    return this.shelf === 'maps' && this.sites.editor.map ? this.sites.editor : null;
  });

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

  /** Once the robot drives, what it is driven with goes before. */
  drilling = $derived.by<boolean>(
    () => this.drills.open && this.live.vehicle?.mission.state !== 'running',
  );

  readonly live = new Live();
  readonly target = new Target(this.live);
  readonly notices = new Notices();
  readonly dialogs = new Dialogs();
  readonly editor: Editor;
  readonly library: Library;
  readonly pilot: Pilot;
  readonly drivers: Drivers;
  readonly sky: Sky;
  readonly teacher: Teacher;
  readonly runs: Runs;
  readonly slips: Slips;
  readonly seen: Seen;
  readonly sites: SiteMaps;
  readonly standing: Standing;
  readonly drills: Drills;
  readonly surveyor: Surveyor;
  readonly fences: Fences;
  readonly homeward: Homeward;
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
    this.editor = new Editor(doors.missions, doors.storage, this.notices, this.dialogs);
    this.library = new Library(
      doors.missions,
      this.editor,
      this.notices,
      this.dialogs,
      () => this.live.vehicle?.home ?? robot_place(this.live.vehicle),
    );
    this.pilot = new Pilot(doors.vehicle, doors.link, this.live, this.notices, this.dialogs);
    this.drivers = new Drivers(doors.vehicle, this.notices, this.dialogs);
    this.sky = new Sky(doors.vehicle);
    this.runs = new Runs(doors.runs);
    this.slips = new Slips(doors.slips, this.dialogs);
    this.seen = new Seen(doors.seen, doors.link, this.live, doors.layers);
    this.sites = new SiteMaps(doors.sites, this.live, this.notices, this.dialogs);
    this.standing = new Standing(this.live, this.pilot);
    this.drills = new Drills(doors.drill);
    this.surveyor = new Surveyor(doors.survey, this.editor, this.notices);
    this.fences = new Fences(doors.fences, this.notices, this.dialogs);
    this.homeward = new Homeward(doors.vehicle, this.live);
    this.route = new LoadedRoute(doors.missions, doors.vehicle, this.notices);
    this.calibrator = new Calibrator(doors.vehicle, this.dialogs);
    this.resumption = new Resumption(doors.vehicle, this.pilot, this.notices, this.dialogs);
    this.findings = new Findings(doors.missions);
    this.teacher = new Teacher(doors.teach, this.editor, this.notices, this.dialogs);
    this.#past_way = new PastWay(doors.vehicle, this.live, doors.map);
    doors.map.listen(this.#map_events());
    if (this.editor.restore_draft()) this.map.fit(spots(this.editor.plan));
    void this.#fetch_past_events();
    $effect.root(() => this.#keep_map_in_step());
  }

  readonly stream_events: StreamEvents = {
    on_link: (link) => {
      const was_open = this.live.link.socket === 'open';
      this.live.link = link;
      this.live.now_ms = performance.now(); // an age is never told too small
      if (link.socket !== 'open' || was_open) return;
      void this.#fetch_past_events();
      void this.resumption.refresh();
      this.#past_way.connected();
    },
    on_hello: (capabilities) => {
      this.live.capabilities = capabilities;
      this.map.set_size(capabilities.size.length_m, capabilities.size.width_m);
    },
    on_vehicle: (vehicle, mono_s) => {
      this.live.take(vehicle);
      this.standing.take(vehicle);
      this.pilot.halts.on_vehicle(vehicle, mono_s);
      this.findings.take(vehicle);
      void this.#past_way.complete();
      if (this.route.take(vehicle)) void this.resumption.refresh();
    },
    on_refused: (refusal) => this.live.refuse_stick(refusal_text(refusal)),
    on_stopped: () => this.pilot.halts.on_stopped(),
    on_event: (event) => {
      this.notices.event(event);
      this.seen.on_event(event.kind);
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
    const places = field_places(area);
    this.surveyor.name = area.name;
    this.surveyor.outline.begin(places);
    this.surveyor.open = true;
    this.tab = 'plan';
    this.set_follow(false);
    this.map.fit(places);
  }

  /** Shows the edited mission, or the loaded one, or the way so far. */
  fit(): void {
    const edited = spots(this.editor.plan);
    const points = edited.length > 0 ? edited : this.route.plan ? spots(this.route.plan) : [];
    const all = points.length > 0 ? points : this.live.places;
    if (all.length === 0) return;
    this.set_follow(false);
    this.map.fit(all);
  }

  /** The panel has its new height, and the map knows it. */
  async settled(): Promise<void> {
    await tick();
    const frame = (): Promise<number> => new Promise(requestAnimationFrame);
    await frame();
    await frame();
  }

  /** Opens an item of the edited mission. @param item from 1 */
  show_item(item: number): void {
    this.dialogs.close();
    this.editor.selected = item - 1;
    this.tab = 'plan';
  }

  /** Straight to where it can be seen what it would do. */
  async show_way_home(mode: HomeMode): Promise<void> {
    this.dialogs.close();
    this.tab = 'drive';
    this.sheet_open = true;
    await this.homeward.show(mode);
    await this.settled();
    const line = this.homeward.way?.line ?? [];
    if (line.length < 2) return;
    this.set_follow(false);
    this.map.fit(line);
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

  async #fetch_past_events(): Promise<void> {
    const answer = await this.#doors.vehicle.recent_events();
    if (answer.ok) this.notices.past_events(answer.value.items);
  }

  #map_events(): MapEvents {
    const drawn = (): Drawing => this.drawing ?? this.editor;
    return {
      on_add: (at) => drawn().add(at),
      on_insert: (index, at) => drawn().insert(index, at),
      on_move: (index, to) => drawn().move(index, to),
      on_select: (index) => {
        drawn().select(index);
        if (index !== null && this.drawing === null) this.tab = 'plan';
      },
      on_place: (at) => {
        if (this.tab !== 'drive') return;
        this.target.choose(at);
        this.sheet_open = true;
      },
      on_point: (at, toward) => this.standing.point(at, toward),
      on_pan: () => {
        if (this.follow) this.set_follow(false);
      },
    };
  }

  #keep_map_in_step(): void {
    const { editor, live, map } = this;
    // A map that moves under the finger cannot be drawn on.
    $effect(() => {
      const drawn_on = this.tab === 'plan' || this.drawing !== null || this.pointing;
      map.set_follow(this.follow && !drawn_on);
    });
    $effect(() => {
      const edits = this.tab === 'plan' ? editor.map_mode : 'watch';
      map.set_mode(this.pointing ? 'point' : (this.drawing?.map_mode ?? edits));
    });
    // A run is looked at, and a field drawn, without what is planned otherwise.
    const looks_back = $derived(this.tab === 'missions' && this.shelf === 'runs');
    $effect(() => {
      const surveys = this.drawing === this.surveyor.outline;
      map.show_runs(looks_back ? this.runs.on_map : surveys ? this.surveyor.on_map : []);
    });
    $effect(() => {
      const { drawing } = this;
      const hidden = looks_back && this.runs.first;
      const { plan, selected, shape } = drawing ?? editor;
      const refused = drawing ? NOTHING : editor.refused;
      map.show_plan(hidden ? EMPTY_PLAN : plan, selected, refused, shape);
    });
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
    $effect(() =>
      map.show_route(this.route.plan, this.route.way, live.vehicle?.mission.current_item ?? 0),
    );
    $effect(() => map.show_slips(this.slips.on_map));
    // As long as somebody sees them: in the log, or on the map.
    const slips_seen = $derived(this.slips.shown || this.tab === 'log');
    $effect(() => (slips_seen ? untrack(() => this.slips.watch()) : undefined));
    this.#keep_site_in_step();
    $effect(() => this.seen.follow_layers());
    $effect(() => map.show_seen(this.seen.on_map));
    $effect(() => map.show_ahead(this.seen.ahead));
    $effect(() => map.show_space(this.calibrator.space));
    $effect(() => map.show_robot(live.robot, live.tracks));
    $effect(() => map.show_home(live.vehicle?.home ?? null));
    $effect(() => {
      const pin = this.tab === 'drive' ? (this.standing.mark ?? this.target.mark) : null;
      const home = this.tab === 'drive' ? this.homeward.mark : null;
      map.show_marks(pin, home ?? activity_mark(live.vehicle));
    });
  }

  #keep_site_in_step(): void {
    const { live, map } = this;
    // Where there is a map in use; and in the list of maps, which one may be.
    const maps_seen = $derived(this.tab === 'missions' && this.shelf === 'maps');
    const located = $derived((live.vehicle?.place?.state ?? 'off') !== 'off');
    const map_in_use = $derived(live.vehicle?.place?.map_id ?? null);
    const site_wanted = $derived(maps_seen || (located && this.seen.layers.map));
    $effect(() => {
      void map_in_use; // another one: whoever changed it
      return site_wanted ? untrack(() => this.sites.watch()) : undefined;
    });
    $effect(() => this.sites.look(maps_seen));
    $effect(() => map.show_site(site_wanted ? this.sites.on_map : null));
    $effect(() => map.show_site_edits(maps_seen ? this.sites.editor.edits : []));
  }
}
