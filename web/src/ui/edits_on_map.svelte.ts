// Keeps the map in step with what is edited: the plan, what is chosen of it, and what it is compared
// with.

import { untrack } from 'svelte';

import { other_on_map } from '../model/compare';
import { is_loaded, look_of } from '../model/draft';
import { drawn_plan } from '../model/map_plan';
import { drawn_on_map } from '../model/makings';
import type { LineOnMap } from '../model/on_map';
import { EMPTY_PLAN, spots } from '../model/plan';
import { NOTHING_PICKED } from '../model/selection';
import { settled } from './settled';
import type { Station } from './station.svelte';

const NOTHING: ReadonlySet<number> = new Set();

/** What lies beside another drawing than the mission's. */
const beside = ({ drawing, surveyor, measurer, editor }: Station): readonly LineOnMap[] =>
  drawing === surveyor.outline
    ? surveyor.others
    : drawing === measurer
      ? [{ places: spots(editor.plan), tone: 'other' }] // to measure from
      : [];

/**
 * What was drawn before the page was opened anew: until its panel is open, nobody knows what that will
 * cover. Where the robot is known the map stays with it.
 */
const see_draft = ({ editor, live, map }: Station, planning: () => boolean): void => {
  let opened = false;
  $effect(() => {
    if (opened || !planning()) return;
    opened = true;
    const places = untrack(() => (live.robot === null ? spots(editor.plan) : []));
    if (places.length > 0) void settled().then(() => map.fit(places));
  });
};

/** Called where effects may begin. @param hidden something else is looked at instead */
export const keep_edits_in_step = (station: Station, hidden: () => boolean): void => {
  const { editor, map, shaping } = station;
  const loaded = $derived(
    is_loaded(editor.stored, editor.unsaved, station.live.vehicle?.mission ?? null),
  );
  const drives = $derived(station.tab === 'drive');
  const has_route = $derived(station.route.plan !== null);
  const planned = $derived(station.tab === 'plan' && station.drawing === null);
  const drawn_in = $derived(planned ? station.in_map.by : station.in_map.laid);
  $effect(() => {
    const { drawing } = station;
    const { plan, selected, shape } = drawing ?? editor;
    const shown = drawing ? plan : drawn_plan(shaping.preview ?? plan, drawn_in);
    const look = look_of(shape, drives, loaded, has_route);
    const refused = drawing ? NOTHING : editor.refused;
    map.show_plan(hidden() ? EMPTY_PLAN : shown, selected, refused, look.shape, look.faint);
  });
  const same_numbers = $derived(
    shaping.preview === null || shaping.preview.items.length === editor.plan.items.length,
  );
  $effect(() => map.show_picked(planned && same_numbers ? editor.picked : NOTHING_PICKED));
  const theirs = $derived(
    editor.theirs ? other_on_map(editor.plan, editor.theirs, 'theirs') : null,
  );
  const compared = $derived(theirs ?? [...shaping.beside, ...station.revisions.on_map]);
  const made = $derived(station.makings.here);
  const made_on_map = $derived(
    made && !made.by_hand ? drawn_on_map(made.drawn, editor.plan.items) : [],
  );
  const told = $derived(
    station.dialogs.open?.kind === 'report' ? station.dialogs.open.report.on_map : null,
  );
  $effect(() =>
    map.show_beside(
      told ??
        (planned ? [...made_on_map, ...station.beneath.on_map, ...compared] : beside(station)),
    ),
  );
  // Where they differ is seen before the person chooses.
  $effect(() => {
    const { theirs: other } = editor;
    if (other === null) return;
    untrack(() => {
      station.tab = 'plan';
      station.set_follow(false);
      map.fit([...spots(editor.plan), ...spots(other)]);
    });
  });
  see_draft(station, () => station.tab === 'plan');
  $effect(() => map.set_snap(editor.snaps));
};
