// What is shown when the whole of it is asked for.

import { drawn_on_map } from '../model/makings';
import { drawn_plan } from '../model/map_plan';
import { spots, type LatLon } from '../model/plan';
import type { Station } from './station.svelte';

/** Rows have no points: they lie where they were drawn. */
const edited_in = ({ editor, makings, in_map, tab }: Station): readonly LatLon[] => {
  const made = makings.here;
  const drawn = made && !made.by_hand ? drawn_on_map(made.drawn, editor.plan.items) : [];
  const planned = drawn_plan(editor.plan, tab === 'plan' ? in_map.by : in_map.laid);
  return [...spots(planned), ...drawn.flatMap(({ places }) => places)];
};

/** What a report tells of, or the edited mission, or the loaded one, or the way so far. */
export const whole_of = (station: Station): readonly LatLon[] => {
  const { dialogs, route, live } = station;
  const told = dialogs.open?.kind === 'report' ? dialogs.open.report.places : [];
  if (told.length > 0) return told;
  const edited = edited_in(station);
  if (edited.length > 0) return edited;
  const loaded = route.plan ? spots(route.plan) : [];
  return loaded.length > 0 ? loaded : live.places;
};
