// Refusals of a block of rows, as the robot writes them, in the page's words.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { afterEach, describe, expect, it } from 'vitest';

import type { FieldError } from '../src/model/answer';
import { CAUSES, row_refusal } from '../src/model/row_refusal';
import { IN_ENGLISH, speak } from '../src/model/say';
import { finnish } from '../src/texts/fi';

const ROWS = join(import.meta.dirname, '../../server/mission/rows');

/** What the server's sources say, whole: a 7 stands for what is put between two pieces. */
const server_says = (): readonly string[] =>
  ['block.cpp', 'lies.cpp'].flatMap((name) =>
    [
      ...readFileSync(join(ROWS, name), 'utf8')
        .replace(/\/\/.*$/gm, '')
        .replace(/"\s*\n\s*"/g, '')
        .replace(/"\s*\+[^";]*\+\s*"/g, '7')
        .matchAll(/"([^"]+)"/g),
    ].map(([, text = '']) => text),
  );

const refused = (...errors: readonly FieldError[]): string =>
  row_refusal({
    status: 422,
    title: 'Invalid',
    detail: `${errors[0]?.pointer ?? ''} ${errors[0]?.detail ?? ''}`,
    errors,
  });
const at = (pointer: string, detail: string): FieldError => ({ pointer, detail });

describe('a refused block of rows', () => {
  afterEach(() => {
    speak(() => IN_ENGLISH);
  });

  it.each([
    [
      '/turn_kind',
      'this vehicle cannot turn on the spot: must be arc, omega, shunt or auto',
      'This vehicle does not turn on the spot: choose arcs.',
    ],
    [
      '/radius_m',
      'must be at least 4.6: this vehicle turns no narrower',
      'This vehicle turns no narrower than 4.6 m: give a wider radius.',
    ],
    [
      '/radius_m',
      'acts with arcs alone, and this turns on the spot: turn_kind must be arc, omega or shunt',
      'A radius is for arcs: choose them, or leave it empty.',
    ],
    [
      '/radius_m',
      'is required: this vehicle turns on the spot, so that its profile does not tell one',
      'Give the radius of the arcs: this vehicle turns on the spot and has none of its own.',
    ],
    [
      '/turn_kind',
      'arcs with a radius of 5.0 m need lanes 10.0 m apart: must be omega or shunt, or leave rows out (skip)',
      'Arcs with a radius of 5.0 m need rows 10.0 m apart: leave rows out each time, or choose ' +
        '“arcs, out and round” or “arcs, and back between”.',
    ],
    [
      '/turn_kind',
      'no arc leads back into the same row: must be omega, shunt, pivot or auto',
      'No arc leads back into the same row: choose another turn, or drive there and back by turns.',
    ],
    [
      '/rows',
      'cannot be driven by sight with a trailer (nav.tool.trailer_m)',
      'Rows are not driven by sight with a trailer.',
    ],
    [
      '/block/1',
      'lies less than 1 m from the first place: row 1 leads from one to the other',
      'Row 1 is shorter than 1 m: draw it longer.',
    ],
    ['/block/1', 'lies more than 5 km from the first place', 'Row 1 ends more than 5 km away.'],
    [
      '/out_m',
      'must be from 0.1 to 6: farther off the next row is not seen',
      'Out of a row before it turns, m: from 0.1 to 6.',
    ],
    ['/spacing_m', 'must be from 0.3 to 50, is 60', 'From row to row, m: from 0.3 to 50.'],
  ])('says of %s: %s', (pointer, detail, words) => {
    expect(refused(at(pointer, detail))).toBe(words);
  });

  it('says all causes, and in the language that is chosen', () => {
    const both = [
      at('/turn_kind', 'this vehicle cannot turn on the spot: must be arc, omega, shunt or auto'),
      at('/radius_m', 'must be at least 4.6: this vehicle turns no narrower'),
    ];
    expect(refused(...both)).toBe(
      'This vehicle does not turn on the spot: choose arcs. ' +
        'This vehicle turns no narrower than 4.6 m: give a wider radius.',
    );
    speak(() => ({ language: 'fi', texts: finnish }));
    expect(refused(...both)).toContain('Tämä ajoneuvo ei käänny paikallaan: valitse kaaret.');
  });

  it.each(CAUSES.map(({ pointer, said }) => [pointer, said] as const))(
    'is known by what the server says of %s: %s',
    (_, said) => {
      expect(server_says().filter((text) => said.test(text))).not.toEqual([]);
    },
  );

  it('leaves what it has no words for as the robot says it', () => {
    expect(refused(at('/block', 'crosses itself'))).toBe('block crosses itself');
  });
});
