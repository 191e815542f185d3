import { describe, expect, test } from 'vitest';

import { offset_between } from '../src/model/geo';
import type { PlanMap } from '../src/model/map_plan';
import {
  append_way,
  graph_on_map,
  why_not_way,
  type NodeGraphWithNodes,
} from '../src/model/node_graph';
import type { Plan } from '../src/model/plan';
import { SHED } from './shed';

//   shed: 1 ── 2 ─▶ 3 on the street
const graph: NodeGraphWithNodes = {
  id: 'g',
  name: 'ways',
  map: 'shed',
  home: 1,
  nodes: 3,
  links: 3,
  node_list: [
    { id: 1, x_m: 0, y_m: 0, lat: null, lon: null, links: [2] },
    { id: 2, x_m: 4, y_m: 0, lat: null, lon: null, links: [1, 3] },
    { id: 3, x_m: null, y_m: null, lat: 58.001, lon: 26, links: [] },
  ],
};
const at = { lat: 58, lon: 26, heading_deg: 0 };
const by: PlanMap = { map: SHED, at };
const empty: Plan = { name: '', items: [] };

describe('a route graph', () => {
  test('lies where the map is drawn that is planned in', () => {
    const { nodes, links } = graph_on_map(graph, by);
    expect(nodes.map(({ id, home }) => [id, home])).toEqual([
      [1, true],
      [2, false],
      [3, false],
    ]);
    const [first, second] = nodes;
    // x looks north.
    expect(first && second && offset_between(first, second).north_m).toBeCloseTo(4, 3);
    expect(links.map(({ one_way }) => one_way)).toEqual([false, true]);
  });

  test('is drawn where nothing else is planned in as far as it lies somewhere', () => {
    expect(graph_on_map(graph, null).nodes.map(({ id }) => id)).toEqual([3]);
    expect(graph_on_map(graph, { map: { ...SHED, name: 'yard' }, at }).links).toEqual([]);
    const [known] = graph.node_list.map((node) => ({ ...node, lat: 58.5, lon: 26 }));
    const laid = known && graph_on_map({ ...graph, node_list: [known] }, null);
    expect(laid?.nodes[0]?.lat).toBe(58.5);
  });

  test('says why no way of it can be planned', () => {
    const way = { from: null, to: 2 };
    expect(why_not_way(graph, way, empty)).toBeNull();
    expect(why_not_way(graph, way, { ...empty, frame: { map: 'shed' } })).toBeNull();
    expect(why_not_way(null, way, empty)).toBe('Choose a route graph first.');
    expect(why_not_way(graph, { from: 1, to: null }, empty)).toBe('Say to which node.');
    expect(why_not_way(graph, { from: 9, to: 2 }, empty)).toBe('The graph has no node 9.');
    expect(why_not_way(graph, way, { ...empty, frame: { map: 'yard' } })).toBe(
      'The mission counts from the map “yard”, the graph from “shed”.',
    );
  });

  test('adds a way behind what is planned, with the map that it counts from', () => {
    const way: Plan = {
      name: 'way',
      frame: { map: 'shed' },
      items: [{ type: 'map_point', x_m: 4, y_m: 0 }],
    };
    const plan = append_way(way)({ name: 'mine', items: [{ type: 'wait', seconds: 1 }] });
    expect(plan.name).toBe('mine');
    expect(plan.frame).toEqual({ map: 'shed' });
    expect(plan.items.map(({ type }) => type)).toEqual(['wait', 'map_point']);
    // Outside the map it counts from none.
    const street = append_way({ name: 'way', items: [] })(plan);
    expect(street.frame).toEqual({ map: 'shed' });
  });
});
