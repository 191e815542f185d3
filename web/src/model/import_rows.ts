// Where something stands in an imported file, in words: files of JSON have no lines that a person would
// count, and the robot tells a pointer (RFC 6901) into them.

import { say, type PlainKey } from './say';

const MEMBERS: Readonly<Record<string, PlainKey>> = {
  items: 'file_item',
  areas: 'file_area',
  features: 'file_feature',
  polygons: 'file_polygon',
  circles: 'file_circle',
  points: 'file_point',
  polygon: 'file_point',
  coordinates: 'file_point',
  geometries: 'file_shape',
  waypoints: 'file_item',
};

/** Lists that need no name of their own: "mission", "geometry". */
const SILENT: ReadonlySet<string> = new Set([
  'mission',
  'geometry',
  'geoFence',
  'rallyPoints',
  'properties',
]);

/** "/mission/items/2" → "item 3"; "line 7" stays. */
export const row_words = (row: string): string => {
  if (!row.startsWith('/')) {
    return row.replace(/\b(line|coordinate|corner)(?= \d)/g, (word) =>
      say(word === 'line' ? 'file_line' : 'file_point'),
    );
  }
  const parts = row.split('/').slice(1);
  const words: string[] = [];
  let list = '';
  for (const part of parts) {
    const number = /^\d+$/.test(part) ? Number(part) + 1 : null;
    if (number === null) {
      list = part;
      if (!(part in MEMBERS) && !SILENT.has(part)) words.push(part);
      continue;
    }
    const member = MEMBERS[list];
    words.push(member ? `${say(member)} ${number}` : `${number}`);
  }
  return words.join(', ') || row;
};
