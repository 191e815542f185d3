import { describe, expect, test } from 'vitest';

import { draft_text, parse_draft } from '../src/model/draft';
import {
  field_value,
  fields_of,
  fresh_item,
  read_number,
  with_field,
  type NumberField,
} from '../src/model/fields';
import {
  item_title,
  place_of,
  spots,
  type Item,
  type ItemType,
  type Plan,
} from '../src/model/plan';

const number_field = (type: ItemType, key: string): NumberField => {
  const field = fields_of[type].find((each) => each.key === key);
  if (field?.kind !== 'number') throw new Error(`no number field ${key}`);
  return field;
};

describe('fields', () => {
  test('read what people type: commas, blanks and the typographic minus', () => {
    const lat = number_field('waypoint', 'lat');
    expect(read_number(lat, ' 58,37802 ', 'Latitude')).toEqual({ ok: true, value: 58.37802 });
    expect(read_number(lat, '−12.5', 'Latitude')).toEqual({ ok: true, value: -12.5 });
  });

  test('refuse what is out of range, no number, or missing, and name the field', () => {
    const lat = number_field('waypoint', 'lat');
    for (const text of ['91', '-90.1', 'north', '', 'Infinity', '1e999']) {
      const read = read_number(lat, text, 'Latitude');
      expect(read.ok).toBe(false);
      if (!read.ok) expect(read.error).toContain('Latitude');
    }
    expect(read_number(number_field('dock', 'tag'), '587', 'Latitude').ok).toBe(false);
    expect(read_number(number_field('dock', 'tag'), '1.5', 'Latitude').ok).toBe(false);
    expect(read_number(number_field('jump', 'item'), '1.5', 'Latitude').ok).toBe(false);
  });

  test('an empty optional field takes the value out', () => {
    expect(read_number(number_field('waypoint', 'speed_mps'), ' ', 'Latitude')).toEqual({
      ok: true,
      value: null,
    });
    const item: Item = { type: 'waypoint', lat: 1, lon: 2, speed_mps: 1 };
    expect(with_field(item, 'speed_mps', null)).toEqual({ type: 'waypoint', lat: 1, lon: 2 });
  });

  test('a turn is either relative or absolute', () => {
    const turned = with_field({ type: 'turn', turn_deg: 90 }, 'heading_deg', 180);
    expect(turned).toEqual({ type: 'turn', heading_deg: 180 });
  });

  test('landmarks have an offset with its side, or a side alone', () => {
    const cones: Item = { type: 'landmarks', name: 'cone', offset_m: 0.7 };
    expect(field_value(cones, 'side')).toBe('right');
    const emptied = with_field(cones, 'offset_m', null);
    expect(emptied).toEqual({ type: 'landmarks', name: 'cone', side: 'right' });
    expect(with_field(cones, 'side', 'left')).toEqual({ ...cones, offset_m: -0.7 });
    expect(with_field(emptied, 'side', 'left')).toEqual({ ...emptied, side: 'left' });
    expect(with_field(emptied, 'offset_m', -0.8)).toEqual({ ...cones, offset_m: -0.8 });
  });

  test('a first offset of landmarks lies on the side that was chosen', () => {
    const of = (side: 'left' | 'right'): Item => ({ type: 'landmarks', name: 'cone', side });
    const typed = (item: Item, offset_m: number): unknown =>
      field_value(with_field(item, 'offset_m', offset_m), 'offset_m');
    expect(typed(of('left'), 0.7)).toBe(-0.7);
    expect(typed(of('right'), 0.7)).toBe(0.7);
    expect(typed({ type: 'landmarks', name: 'cone' }, 0.7)).toBe(-0.7);
    // A sign says the side, and so does a number in place of another one.
    expect(typed(of('right'), -0.7)).toBe(-0.7);
    expect(typed({ type: 'landmarks', name: 'cone', offset_m: -0.7 }, 0.5)).toBe(0.5);
  });

  test('what says no distance is told by its side', () => {
    expect(item_title({ type: 'wall', side: 'right' })).toBe('Wall on the right');
    expect(item_title({ type: 'wall', side: 'right', distance_m: 0.9 })).toBe(
      'Wall on the right, 0.9 m',
    );
    expect(item_title({ type: 'landmarks', name: 'cone', side: 'left' })).toBe(
      'Landmarks “cone” on the left',
    );
  });

  test('every kind of item has a title, and a fresh one passes its own checks', () => {
    for (const type of Object.keys(fields_of) as ItemType[]) {
      const item: Item = type === 'waypoint' ? { type, lat: 1, lon: 2 } : fresh_item(type, null);
      expect(item_title(item)).not.toBe('');
      const draft = { plan: { name: 'P', items: [item] }, stored: null, unsaved: true };
      expect(parse_draft(draft_text(draft))).toEqual(draft);
    }
  });

  test('a turn with a radius is told as an arc, by an angle or to a heading', () => {
    const titles = (more: object): string[] =>
      [{ turn_deg: 90 }, { heading_deg: 0 }].map((by) =>
        item_title({ type: 'turn', ...by, ...more }),
      );
    expect(titles({ radius_m: 1.2 })).toEqual([
      'Turn 90° on an arc of 1.2 m',
      'Turn to heading 0° on an arc of 1.2 m',
    ]);
    expect(titles({})).toEqual(['Turn 90°', 'Turn to heading 0°']);
  });

  test('a place is latitude and longitude, or none', () => {
    const here = { lat: 58.1, lon: 26.2 };
    const item = fresh_item('loiter', here);
    expect(item).toEqual({ type: 'loiter', ...here, seconds: 30 });
    expect(with_field(item, 'lon', null)).toEqual({ type: 'loiter', seconds: 30 });
    expect(place_of(fresh_item('loiter', null))).toBeNull();
    expect(place_of(fresh_item('circle', here))).toEqual(here);
    expect(item_title({ type: 'circle', ...here, radius_m: 4, clockwise: true })).toBe(
      'Circle of 4 m, 1 turn to the right',
    );
  });

  test('items without a place are none on the map', () => {
    const plan: Plan = {
      name: 'P',
      items: [
        fresh_item('wait', null),
        { type: 'waypoint', lat: 1, lon: 2 },
        fresh_item('turn', null),
        fresh_item('loiter', null),
        fresh_item('circle', { lat: 3, lon: 4 }),
      ],
    };
    expect(spots(plan)).toEqual([
      { index: 1, lat: 1, lon: 2 },
      { index: 4, lat: 3, lon: 4 },
    ]);
  });
});

describe('drafts', () => {
  const draft = {
    plan: { name: 'P', items: [{ type: 'waypoint' as const, lat: 58, lon: 26, hold_s: 2 }] },
    stored: { id: 'abc', revision: 3 },
    unsaved: true,
  };

  test('come back as they were', () => {
    expect(parse_draft(draft_text(draft))).toEqual(draft);
  });

  test('that are damaged, of another version or of another program are no drafts', () => {
    const text = draft_text(draft);
    expect(parse_draft(null)).toBeNull();
    expect(parse_draft(text.slice(0, -3))).toBeNull();
    expect(parse_draft('[]')).toBeNull();
    expect(parse_draft('{"version":2}')).toBeNull();
    expect(parse_draft(text.replace('"lat":58', '"lat":"58"'))).toBeNull();
    expect(parse_draft(text.replace('"lat":58,', ''))).toBeNull();
    expect(parse_draft(text.replace('"waypoint"', '"teleport"'))).toBeNull();
  });

  test('that lost only their origin begin a new mission', () => {
    const text = draft_text(draft).replace('"revision":3', '"revision":"x"');
    expect(parse_draft(text)?.stored).toBeNull();
  });
});
