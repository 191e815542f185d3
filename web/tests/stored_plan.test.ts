import { describe, expect, test } from 'vitest';

import { rename } from '../src/model/actions';
import { begin_history, perform } from '../src/model/history';
import { edits_resumed } from '../src/model/past_edits';
import type { Mission } from '../src/model/ports';
import { body_of, plan_of } from '../src/model/stored_plan';

const mission: Mission = {
  id: 'm1',
  revision: 3,
  name: 'through the shed',
  items: [{ type: 'map_point', x_m: 2, y_m: -1 }],
  home: { lat: 58.378, lon: 26.729 },
  settings: { at_end: 'return' },
  frame: { map: 'shed' },
  drawing: { kind: 'survey', spacing_m: 2 },
  updated: '2026-11-28T10:00:00Z',
};
const { id, revision, updated, ...content } = mission;
const stored = { id, revision };

describe('a stored mission', () => {
  test('that is opened, edited and saved is sent with all of it: its map too', () => {
    const { history: opened } = edits_resumed([], stored, plan_of(mission));
    const edited = perform(opened, rename('through it'));
    expect(body_of(edited.present)).toEqual({ ...content, name: 'through it' });
  });

  test('that somebody else saved meanwhile is taken with its map', () => {
    const mine = begin_history(plan_of({ ...mission, frame: { map: 'yard' } }));
    const taken = perform(mine, () => plan_of({ ...mission, revision: 4, updated }));
    expect(body_of(taken.present)).toEqual(content);
  });

  test('without a map and a drawing is sent without the two', () => {
    const bare: Mission = { ...stored, name: 'P', items: [], home: null, settings: {}, updated };
    expect(Object.keys(body_of(plan_of(bare)))).toEqual(['name', 'items', 'home', 'settings']);
  });
});
