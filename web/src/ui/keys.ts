// Keys of the whole page. Space stops the robot, whatever is on the screen; only while a person types
// words or a place is it a blank. F8 and Ctrl + Enter always stop; two of them, as on many laptops F8 does
// something else unless Fn is held. Buttons are pressed with Enter. Esc closes what is
// open, as everywhere: whoever wants to be rid of a question must not latch the stop.

import { say } from '../model/say';
import { all_of } from '../model/selection';
import { toggle_map_up } from './map_up';
import type { Station } from './station.svelte';

export const key_words = (): readonly (readonly [keys: string, meaning: string])[] => [
  [say('space_f8_ctrl_plus_enter'), say('emergency_stop_at_once_while_you')],
  ['Esc', say('close_the_dialog_forget_the_chosen')],
  ['Enter', say('press_the_button_that_has_the_focus')],
  [say('ctrl_plus_z'), say('undo_the_last_edit')],
  [say('ctrl_plus_y_ctrl_plus_shift_plus_z'), say('redo')],
  [say('ctrl_plus_s'), say('save_the_mission_the_fence_or_the_map')],
  [say('ctrl_plus_a'), say('select_all_items_esc_ends_selecting')],
  ['Shift', say('while_held_taps_and_boxes_on_the_map')],
  ['Delete', say('delete_what_is_selected')],
  ['F', say('follow_the_robot')],
  ['H', say('turn_the_map')],
  ['+ and −', say('zoom')],
  [say('arrows_or_w_a_s_d'), say('drive_while_the_drive_pad_has_the')],
];

const TYPING = 'input:not([type=checkbox], [type=range], [type=file]), textarea, select';

const is_typing = (target: EventTarget | null): target is Element =>
  target instanceof Element && target.matches(TYPING);

/** A blank means nothing in a list, nor in a number; in a place it does. */
const takes_blanks = (target: EventTarget | null): boolean =>
  is_typing(target) && !target.matches('select, input[inputmode=decimal]:not([data-blanks])');

const edit_key = (station: Station, event: KeyboardEvent): boolean => {
  const { editor } = station;
  const key = event.key.toLowerCase();
  if (!(event.ctrlKey || event.metaKey)) return false;
  const { drawing } = station;
  if (key === 's' && drawing === null) void editor.save();
  else if (key === 's' && drawing === station.fences) void station.fences.save();
  else if (key === 's' && drawing === station.sites.editor) void station.sites.editor.save();
  else if (is_typing(event.target)) return false;
  else if (key === 'a' && drawing === null && station.tab === 'plan') {
    editor.pick_only(all_of(editor.plan));
  } else if (key === 'z' && drawing !== null) drawing.undo();
  else if (key === 'z' && event.shiftKey) editor.redo();
  else if (key === 'z') editor.undo();
  else if (key === 'y' && drawing === null) editor.redo();
  else return false;
  return true;
};

/** What is pulled out in the Drive panel. While the robot comes the card stays: to close it is to stop. */
const close_card = (station: Station): boolean => {
  const { drills, homeward, me } = station;
  if (station.drilling) drills.close();
  else if (homeward.mode !== null) homeward.close();
  else if (me.open && !me.coming) me.close();
  else if (station.drawer !== null) station.drawer = null;
  else return false;
  return true;
};

/** What lies uppermost goes. @return false: nothing was open */
const close_one = (station: Station): boolean => {
  const { dialogs, target, editor, tab, standing, shaping, sites, drawing } = station;
  if (dialogs.open) dialogs.close();
  else if (tab === 'drive' && standing.open) standing.clear();
  else if (drawing === sites.editor && sites.editor.part !== null) sites.editor.choose(null);
  else if (tab === 'drive' && target.at) target.clear();
  else if (tab === 'drive' && close_card(station)) return true;
  else if (tab === 'plan' && shaping.transform) shaping.cancel();
  else if (tab === 'plan' && editor.tool !== 'edit') editor.choose_tool('edit');
  else return false;
  return true;
};

const plain_key = (station: Station, event: KeyboardEvent): boolean => {
  const { editor } = station;
  if (is_typing(event.target) || event.ctrlKey || event.metaKey || event.altKey) return false;
  switch (event.key) {
    case 'Delete':
      if (station.tab !== 'plan' && station.drawing === null) return false;
      (station.drawing ?? editor).remove_selected();
      return true;
    case 'f':
      station.set_follow(!station.follows);
      return true;
    case 'h':
      toggle_map_up(station);
      return true;
    case '+':
      station.map.zoom_by(1);
      return true;
    case '-':
      station.map.zoom_by(-1);
      return true;
    default:
      return false;
  }
};

const stops = (event: KeyboardEvent): boolean => {
  if (event.key === 'F8') return true;
  if (event.key === 'Enter') return event.ctrlKey || event.metaKey;
  return event.key === ' ' && !takes_blanks(event.target);
};

/** @return stops listening */
export const listen_for_keys = (station: Station): (() => void) => {
  const on_key = (event: KeyboardEvent): void => {
    if (stops(event)) {
      event.preventDefault();
      event.stopPropagation();
      if (!event.repeat) station.pilot.estop();
    } else if (event.key === 'Escape') {
      if (close_one(station)) event.preventDefault();
      else if (station.live.vehicle?.armed && !event.repeat) {
        station.notices.show('warning', say('esc_does_not_stop_space_f8_or_ctrl'));
      }
    } else if (edit_key(station, event) || plain_key(station, event)) {
      event.preventDefault();
    }
  };
  // Capture: no widget may swallow a stop.
  window.addEventListener('keydown', on_key, { capture: true });
  return () => window.removeEventListener('keydown', on_key, { capture: true });
};
