// What main.ts hands the station: the doors to the server, the map and the device.

import type {
  DraftStorage,
  DrillCalls,
  FenceCalls,
  LiveLink,
  MapCalls,
  MissionCalls,
  RowsCalls,
  SurveyCalls,
  TeachCalls,
  VehicleCalls,
} from '../model/ports';
import type { TileCalls } from '../model/ground';
import type { RunCalls } from '../model/run_ports';
import type { SeenCalls } from '../model/seen';
import type { SiteMapCalls } from '../model/site_map';
import type { KnownPlaceCalls } from '../model/known_places';
import type { NodeGraphCalls } from '../model/node_graph';
import type { MeCalls } from '../model/me';
import type { SlipCalls } from '../model/slips';
import type { Kept } from './edited';

export interface Doors {
  readonly missions: MissionCalls;
  readonly vehicle: VehicleCalls;
  readonly me: MeCalls;
  readonly teach: TeachCalls;
  readonly runs: RunCalls;
  readonly slips: SlipCalls;
  readonly known: KnownPlaceCalls;
  /** Fetched when it is wanted first. */
  readonly graphs: () => Promise<NodeGraphCalls>;
  readonly seen: SeenCalls;
  readonly sites: SiteMapCalls;
  readonly tiles: TileCalls;
  readonly ground: DraftStorage;
  readonly drill: DrillCalls;
  readonly survey: SurveyCalls;
  readonly rows: RowsCalls;
  readonly fences: FenceCalls;
  readonly map: MapCalls;
  readonly kept: Kept;
  readonly layers: DraftStorage;
  readonly link: LiveLink;
}
