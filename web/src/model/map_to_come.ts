// Stands for the map until it is here: the page tells it what to show as if it were, and the map hears
// the last of each kind, in the order in which they were said; what covers it before all others.

import type { MapCalls } from './ports';

type Name = keyof MapCalls;
type Call = (...told: unknown[]) => unknown;

/** What a map would answer that shows nothing. */
const NOTHING: Readonly<Partial<Record<Name, unknown>>> = { view_bounds: null, zoom_level: 0 };

export interface MapToCome {
  readonly map: MapCalls;
  /** From now on it is told itself. */
  readonly come: (map: MapCalls) => void;
}

export const map_to_come = (): MapToCome => {
  let here: MapCalls | null = null;
  const waiting = new Map<Name, unknown[]>();
  const tell = (map: MapCalls, name: Name, told: unknown[]): unknown =>
    (map[name] as Call).apply(map, told);

  const calls = (name: Name): Call => {
    return (...told) => {
      if (here) return tell(here, name, told);
      waiting.delete(name); // the last one counts, and where it was said
      if (!(name in NOTHING)) waiting.set(name, told);
      return NOTHING[name];
    };
  };
  const kept: Partial<Record<Name, Call>> = {};
  const map = new Proxy({} as MapCalls, {
    get: (_, name: Name) => (kept[name] ??= calls(name)),
  });
  return {
    map,
    come: (come) => {
      here = come;
      // What it shall fit, it fits into what the panels leave now.
      const cover = waiting.get('set_cover');
      if (cover) tell(come, 'set_cover', cover);
      waiting.delete('set_cover');
      for (const [name, told] of waiting) tell(come, name, told);
      waiting.clear();
    },
  };
};
