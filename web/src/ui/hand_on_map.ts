// What a hand on the map does: to what is drawn just now, else to the mission.

import { drag_there, insert_there, move_there } from '../model/map_plan';
import type { LatLon } from '../model/plan';
import type { MapEvents } from '../model/ports';
import type { Station } from './station.svelte';

const add = ({ drawing, editor, in_map }: Station, at: LatLon): void => {
  if (drawing) drawing.add(at);
  else {
    editor.do(insert_there(editor.plan.items.length, at, in_map.by));
    editor.selected = null;
  }
};

const insert = ({ drawing, editor, in_map }: Station, index: number, at: LatLon): void => {
  if (drawing) drawing.insert(index, at);
  else {
    editor.do(insert_there(index, at, in_map.by));
    editor.selected = index;
  }
};

const move = ({ drawing, editor, in_map }: Station, index: number, to: LatLon): void => {
  if (drawing) return drawing.move(index, to);
  if (editor.picked.has(index)) return editor.do(drag_there(editor.picked, index, to, in_map.by));
  if (editor.plan.items[index]?.type !== 'map_point') return editor.move(index, to);
  editor.do(move_there(index, to, in_map.by));
  editor.selected = index;
};

export const hand_on_map = (station: Station): MapEvents => ({
  on_add: (at) => add(station, at),
  on_insert: (index, at) => insert(station, index, at),
  on_move: (index, to) => move(station, index, to),
  on_select: (index) => {
    if (station.shaping.transform && station.drawing === null) return;
    (station.drawing ?? station.editor).select(index);
    if (index !== null && station.drawing === null) station.tab = 'plan';
  },
  on_pick: (index) => {
    if (station.drawing) station.drawing.select(index);
    else station.editor.pick(index);
  },
  on_pick_box: (indices) => {
    if (!station.drawing) station.editor.pick_more(indices);
  },
  on_place: (at) => {
    if (station.tab !== 'drive') return;
    station.target.choose(at);
    station.sheet_open = true;
  },
  on_point: (at, toward) => station.standing.point(at, toward),
  on_pan: () => {
    if (station.follow) station.set_follow(false);
  },
});
