// A graph of nodes and links, along which ways are planned: where its nodes are drawn, and whether a way
// through it fits the mission that is edited.

import type { PlanAction } from './actions';
import type { Answer } from './answer';
import type { PlanMap } from './map_plan';
import type { Item, LatLon, Plan } from './plan';
import { say } from './say';
import { on_earth } from './site_map';

export interface NodeGraph {
  readonly id: string;
  readonly name: string;
  /** In whose metres its nodes lie; null: in none's. */
  readonly map: string | null;
  readonly home: number | null;
  readonly nodes: number;
  readonly links: number;
}
export interface GraphNode {
  readonly id: number;
  /** Null: one of the earth, in a graph that lies in a map. */
  readonly x_m: number | null;
  readonly y_m: number | null;
  /** Null: nobody knows where on the earth it lies. */
  readonly lat: number | null;
  readonly lon: number | null;
  readonly links: readonly number[];
}
export interface NodeGraphWithNodes extends NodeGraph {
  readonly node_list: readonly GraphNode[];
}
/** A line of its file that is worth a look. */
export interface GraphNote {
  readonly line: number;
  readonly detail: string;
}
/** @param from null: where the robot is */
export interface WayWish {
  readonly graph: string;
  readonly from: number | null;
  readonly to: number;
}
export interface NodeGraphCalls {
  all(): Promise<Answer<readonly NodeGraph[]>>;
  read(id: string): Promise<Answer<NodeGraphWithNodes>>;
  /** @param map in whose metres its nodes lie */
  add(
    file: File,
    map: string,
  ): Promise<Answer<NodeGraph & { readonly notes: readonly GraphNote[] }>>;
  forget(id: string): Promise<Answer<unknown>>;
  plan(wish: WayWish): Promise<Answer<Plan>>;
}

export interface NodeOnMap extends LatLon {
  readonly id: number;
  readonly home: boolean;
}
export interface LinkOnMap {
  readonly from: LatLon;
  readonly to: LatLon;
  readonly one_way: boolean;
}
export interface GraphOnMap {
  readonly nodes: readonly NodeOnMap[];
  readonly links: readonly LinkOnMap[];
}

/** With the map that is planned in, wherever that is drawn; else where the robot says that it lies. */
const place_of_node = (
  { x_m, y_m, lat, lon }: GraphNode,
  map: string | null,
  by: PlanMap | null,
): LatLon | null => {
  const in_it = by !== null && by.map.name === map && x_m !== null && y_m !== null;
  if (in_it) return on_earth(by.at, { x_m, y_m });
  return lat === null || lon === null ? null : { lat, lon };
};

/** What of it lies somewhere. @param by the map that is planned in; null: none */
export const graph_on_map = (graph: NodeGraphWithNodes, by: PlanMap | null): GraphOnMap => {
  const nodes = new Map<number, NodeOnMap>();
  const links_of = new Map(graph.node_list.map(({ id, links }) => [id, new Set(links)]));
  for (const node of graph.node_list) {
    const at = place_of_node(node, graph.map, by);
    if (at) nodes.set(node.id, { id: node.id, home: node.id === graph.home, ...at });
  }
  const links: LinkOnMap[] = [];
  for (const { id, links: to_all } of graph.node_list) {
    const from = nodes.get(id);
    for (const to_id of to_all) {
      const to = nodes.get(to_id);
      const back = links_of.get(to_id)?.has(id) ?? false;
      if (from && to && !(back && to_id < id)) links.push({ from, to, one_way: !back });
    }
  }
  return { nodes: [...nodes.values()], links };
};

/** "The yard, in the map “shed”". */
export const graph_title = ({ name, map }: NodeGraph): string =>
  map === null ? name : say('graph_in_map', { name, map });

/** "Nodes: 12, links: 20". */
export const graph_size = ({ nodes, links }: NodeGraph): string =>
  say('graph_size', { nodes, links });

/** @return why no way of it can be planned now; null: one can */
export const why_not_way = (
  graph: NodeGraphWithNodes | null,
  { from, to }: { readonly from: number | null; readonly to: number | null },
  plan: Plan,
): string | null => {
  if (graph === null) return say('graph_choose_first');
  const frame = plan.frame?.map;
  if (frame !== undefined && graph.map !== null && frame !== graph.map) {
    return say('graph_of_another_map', { frame, map: graph.map });
  }
  if (to === null) return say('graph_say_where_to');
  const missing = [from, to].find((id) => id !== null && !graph.node_list.some((n) => n.id === id));
  return missing === undefined || missing === null
    ? null
    : say('graph_has_no_node', { id: missing });
};

/** The way behind what is planned already. */
export const append_way =
  (way: Plan): PlanAction =>
  (plan) => {
    const items: readonly Item[] = [...plan.items, ...way.items];
    return way.frame ? { ...plan, frame: way.frame, items } : { ...plan, items };
  };
