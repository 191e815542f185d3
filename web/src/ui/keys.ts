// Keys of the whole page. Space stops the robot, whatever is on the screen; only while a person types
// into a field is it a blank. F8 and Ctrl + Enter always stop; two of them, as on many laptops F8 does
// something else unless Fn is held. Buttons are pressed with Enter. Esc closes what is
// open, as everywhere: whoever wants to be rid of a question must not latch the stop.

import type { Station } from './station.svelte';

export const key_words: readonly (readonly [keys: string, meaning: string])[] = [
  ['Space, F8, Ctrl + Enter', 'Emergency stop, at once; while you type, the last two'],
  ['Esc', 'Close the dialog, forget the chosen place, end showing or adding points'],
  ['Enter', 'Press the button that has the focus'],
  ['Ctrl + Z', 'Undo the last edit'],
  ['Ctrl + Y, Ctrl + Shift + Z', 'Redo'],
  ['Ctrl + S', 'Save the mission, the fence or the map'],
  ['Delete', 'Delete the selected item or corner'],
  ['F', 'Follow the robot'],
  ['+ and −', 'Zoom'],
  ['Arrows or W A S D', 'Drive, while the drive pad has the focus and a key is held'],
];

const TYPING = 'input:not([type=checkbox], [type=range], [type=file]), textarea, select';

const is_typing = (target: EventTarget | null): boolean =>
  target instanceof Element && target.matches(TYPING);

const edit_key = (station: Station, event: KeyboardEvent): boolean => {
  const { editor } = station;
  const key = event.key.toLowerCase();
  if (!(event.ctrlKey || event.metaKey)) return false;
  const { drawing } = station;
  if (key === 's' && drawing === null) void editor.save();
  else if (key === 's' && drawing === station.fences) void station.fences.save();
  else if (key === 's' && drawing === station.sites.editor) void station.sites.editor.save();
  else if (is_typing(event.target)) return false;
  else if (key === 'z' && drawing !== null) drawing.undo();
  else if (key === 'z' && event.shiftKey) editor.redo();
  else if (key === 'z') editor.undo();
  else if (key === 'y' && drawing === null) editor.redo();
  else return false;
  return true;
};

/** What lies uppermost goes. @return false: nothing was open */
const close_one = ({
  dialogs,
  target,
  editor,
  tab,
  standing,
  sites,
  drawing,
}: Station): boolean => {
  if (dialogs.open) dialogs.close();
  else if (tab === 'drive' && standing.open) standing.clear();
  else if (drawing === sites.editor && sites.editor.part !== null) sites.editor.choose(null);
  else if (tab === 'drive' && target.at) target.clear();
  else if (tab === 'plan' && editor.adding) editor.adding = false;
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
      station.set_follow(!station.follow);
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
  return event.key === ' ' && !is_typing(event.target);
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
        station.notices.show('warning', 'Esc does not stop: Space, F8 or Ctrl + Enter does.');
      }
    } else if (edit_key(station, event) || plain_key(station, event)) {
      event.preventDefault();
    }
  };
  // Capture: no widget may swallow a stop.
  window.addEventListener('keydown', on_key, { capture: true });
  return () => window.removeEventListener('keydown', on_key, { capture: true });
};
