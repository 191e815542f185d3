// What the robot's sensors see, as the interface tells it, and the words for it.

import type { Answer } from './answer';
import { age, number_text, sentence, side_word } from './format';
import type { KnownMarks } from './marks';
import type { LatLon } from './plan';
import { say, told } from './say';
import type { GuardFigures, Sweep } from './sweep';
import type { Capabilities } from './vehicle';

/** A place on the map, and a direction there. */
export interface Placed extends LatLon {
  readonly heading_deg: number;
}
export interface SeenGrid {
  readonly age_s: number;
  /** The corner of the first cell; rows run along the heading, the next row lies to its left. */
  readonly at: Placed | null;
  readonly cell_m: number;
  readonly columns: number;
  readonly rows: number;
  /** A byte for each run of equal cells: the kind in the two upper bits, one less than the length in
   * the others. */
  readonly runs: ArrayLike<number>;
}
export interface SensorDots {
  readonly sensor: string;
  readonly age_s: number;
  /** Ahead and left of one point after the other. */
  readonly obstacle_cm: readonly number[];
  readonly overhang_cm: readonly number[];
  readonly drop_cm: readonly number[];
  readonly passing_cm: readonly number[];
}
export interface SeenScan {
  readonly age_s: number;
  /** Where the robot was. */
  readonly at: Placed | null;
  readonly sensors: readonly SensorDots[];
}
export interface SeenThing {
  readonly what: 'obstacle' | 'drop';
  readonly lat: number | null;
  readonly lon: number | null;
  readonly distance_m: number;
  readonly bearing_deg: number;
  readonly clearance_m: number;
  readonly size_m: number;
  readonly age_s: number;
  readonly sensor: string | null;
  readonly on_way: boolean;
}
export interface SeenThings {
  readonly age_s: number | null;
  readonly complete: boolean;
  readonly items: readonly SeenThing[];
}
export interface Sensor {
  readonly name: string;
  readonly kind: string;
  readonly required: boolean;
  readonly health: 'silent' | 'blind' | 'degraded' | 'good';
  readonly reason: string;
  readonly window: 'unknown' | 'clean' | 'dirty' | 'blocked';
  readonly age_s: number | null;
  readonly rate_hz: number;
  /** Of its directions. */
  readonly unknown_part: number;
  readonly points: number;
  /** Whole pieces that the picture could not use. */
  readonly refused: number;
  readonly lost: number;
  readonly duplicates: number;
  /** What came and was refused: cut, damaged, another device's. */
  readonly malformed: number;
  readonly foreign: number;
  readonly malformed_last: string | null;
  readonly malformed_age_s: number | null;
  readonly mount: {
    readonly x_m: number;
    readonly y_m: number;
    readonly z_m: number;
    readonly roll_deg: number;
    readonly pitch_deg: number;
    readonly yaw_deg: number;
  };
}

/** What of it is drawn. */
export interface SeenOnMap {
  readonly grid: SeenGrid | null;
  readonly scan: SeenScan | null;
  readonly things: readonly SeenThing[];
}
/** What the robot is about to do, by what it sees. */
export interface AheadOnMap {
  readonly sweep: Sweep | null;
  /** What limits the drive, or stops it. */
  readonly block: (LatLon & { readonly stops: boolean }) | null;
  /** A way around it. */
  readonly detour: readonly LatLon[];
}

export type SeenTopic = 'grid' | 'scan' | 'obstacles';
export interface SeenLink {
  /** Topics besides those of every page, with their rates; instead of those before. */
  watch(rates_hz: Readonly<Partial<Record<SeenTopic, number>>>): void;
}
export interface SeenEvents {
  on_grid?(grid: SeenGrid): void;
  on_scan?(scan: SeenScan): void;
  on_things?(things: SeenThings): void;
}
export interface SeenCalls {
  sensors(): Promise<Answer<{ readonly items: readonly Sensor[] }>>;
  landmarks(): Promise<Answer<KnownMarks>>;
  /** By what the guard reckons, as it is now. */
  capabilities(): Promise<Answer<Capabilities>>;
}
export interface SeenMap {
  /** What the sensors see; null: it is not looked at. */
  show_seen(seen: SeenOnMap | null): void;
  /** What comes of it for the drive. */
  show_ahead(ahead: AheadOnMap | null): void;
}

export const UNKNOWN = 0;
export const FREE = 1;
export const OCCUPIED = 2;
export const DROP = 3;
/** The server's bound: a longer side is none of its. */
const MOST_CELLS = 200 * 200;

/** The cells of a grid, row by row; null: it is not what it says. */
export const cells_of = ({ runs, columns, rows }: SeenGrid): Uint8Array | null => {
  const count = columns * rows;
  if (!(count >= 0 && count <= MOST_CELLS)) return null;
  const cells = new Uint8Array(count);
  let at = 0;
  for (let k = 0; k < runs.length; k += 1) {
    const byte = runs[k] ?? 0;
    const end = at + (byte & 63) + 1;
    if (end > count) return null;
    cells.fill(byte >> 6, at, end);
    at = end;
  }
  return at === count ? cells : null;
};

export interface Layers {
  readonly scan: boolean;
  readonly grid: boolean;
  /** Of the place, where one is in use. */
  readonly map: boolean;
  /** Stops and the end of waiting are heard. */
  readonly sound: boolean;
}
export const AT_FIRST: Layers = { scan: false, grid: true, map: true, sound: true };

/** As it was kept on the device; what is none is as at first. */
export const layers_from = (text: string | null): Layers => {
  try {
    const kept = JSON.parse(text ?? '{}') as Partial<Record<keyof Layers, unknown>> | null;
    const flag = (name: keyof Layers): boolean => {
      const value = kept?.[name];
      return typeof value === 'boolean' ? value : AT_FIRST[name];
    };
    return {
      scan: flag('scan'),
      grid: flag('grid'),
      map: flag('map'),
      sound: flag('sound'),
    };
  } catch {
    return AT_FIRST;
  }
};

/** For the list of sensors: what the guard keeps, and how it is changed. */
export const guard_line = ({ gap_m, side_m, delay_s, decel_mps2 }: GuardFigures): string =>
  say('the_guard_keeps_gap_before_and_side', {
    gap: number_text(gap_m, 2, 'm'),
    side: number_text(side_m, 2, 'm'),
    delay: number_text(delay_s, 2, 's'),
    decel: number_text(decel_mps2, 2, 'm/s²'),
  });

/** After such an event the guard may reckon with other figures. */
export const changes_guard = (kind: string): boolean =>
  kind === 'parameter' || kind === 'safety_parameter';

/** What the stream must tell for it, Hz. */
export const rates_of = (layers: Layers): Partial<Record<SeenTopic, number>> => ({
  obstacles: 2,
  ...(layers.grid ? { grid: 2 } : {}),
  ...(layers.scan ? { scan: 5 } : {}),
});

export const health_words: Record<Sensor['health'], string> = told({
  good: 'sees',
  degraded: 'sees_badly',
  blind: 'blind',
  silent: 'silent',
});

/** One that is not needed stops nothing. */
export const sensor_tone = ({ health, required }: Sensor): 'good' | 'warn' | 'bad' => {
  if (health === 'good') return 'good';
  return health === 'degraded' || !required ? 'warn' : 'bad';
};

/** "25.0 Hz · 0.04 s ago · 12 % missing" */
export const sensor_line = (sensor: Sensor): string =>
  [
    number_text(sensor.rate_hz, 1, 'Hz'),
    sensor.age_s === null ? say('nothing_seen_yet') : say('age_ago', { age: age(sensor.age_s) }),
    say('unknown_part_percent_missing', { unknown_part: Math.round(sensor.unknown_part * 100) }),
  ].join(' · ');

const window_words: Record<Sensor['window'], string> = told({
  unknown: 'not_told',
  clean: 'clean',
  dirty: 'dirty',
  blocked: 'covered',
});

/** What went wrong on the way, where anything did. */
const losses = (sensor: Sensor): readonly (readonly [string, string])[] => {
  const { malformed_last, malformed_age_s } = sensor;
  const counted: readonly (readonly [string, number])[] = [
    [say('lost_on_the_way'), sensor.lost],
    [say('came_twice'), sensor.duplicates],
    [say('refused_damaged'), sensor.malformed],
    [say('refused_of_no_use'), sensor.refused],
    [say('from_somebody_else'), sensor.foreign],
  ];
  const some = counted.filter(([, n]) => n > 0).map(([what, n]) => [what, String(n)] as const);
  if (some.length === 0) return [[say('lost_or_refused'), say('word_nothing')]];
  if (malformed_last === null) return some;
  const when =
    malformed_age_s === null
      ? ''
      : say('malformed_age_ago', { malformed_age: age(malformed_age_s) });
  return [...some, [say('refused_last'), `${sentence(malformed_last)}${when}`]];
};

export const sensor_details = (sensor: Sensor): readonly (readonly [string, string])[] => {
  const { mount } = sensor;
  const place = say('x_ahead_y_left_z_up', {
    x: number_text(mount.x_m, 2, 'm'),
    y: number_text(mount.y_m, 2, 'm'),
    z: number_text(mount.z_m, 2, 'm'),
  });
  const turned = say('yaw_yaw_pitch_pitch_roll_roll', {
    yaw: number_text(mount.yaw_deg, 1, '°'),
    pitch: number_text(mount.pitch_deg, 1, '°'),
    roll: number_text(mount.roll_deg, 1, '°'),
  });
  return [
    [say('kind'), sensor.kind],
    [say('window'), window_words[sensor.window]],
    [say('points_of_the_last_piece'), String(sensor.points)],
    ...losses(sensor),
    [say('needed_to_drive_by_itself'), sensor.required ? say('word_yes') : say('word_no')],
    [say('mounted'), place],
    [say('turned'), turned],
  ];
};

/** "ahead", "30° left", "behind" */
const direction = (bearing_deg: number): string => {
  const size = Math.round(Math.abs(bearing_deg));
  if (size <= 10) return say('ahead');
  if (size >= 170) return say('behind');
  return `${size}° ${side_word(-bearing_deg)}`;
};

/** A line of the card, on a phone as well: "Obstacle 1.2 m, 30° left · 0.4 m wide · front" */
export const thing_line = (thing: SeenThing): string => {
  const what = thing.what === 'drop' ? say('ground_ends') : say('obstacle');
  const old = thing.age_s >= 2 ? say('age_ago', { age: age(thing.age_s) }) : '';
  const by = [thing.sensor ?? '', old].filter((word) => word !== '').join(', ');
  return [
    `${what} ${number_text(thing.distance_m, 1, 'm')}, ${direction(thing.bearing_deg)}`,
    say('size_wide', { size: number_text(thing.size_m, 1, 'm') }),
    ...(by === '' ? [] : [by]),
  ].join(' · ');
};

/** Which of them get a sign of their own: all that are on the way; of the others, nearest first, those
 * that no sign before them stands on. @param apart whether two would not cover each other */
export const signed_things = (
  things: readonly SeenThing[],
  apart: (one: SeenThing, other: SeenThing) => boolean,
): readonly SeenThing[] => {
  const signed = things.filter((thing) => thing.on_way);
  for (const thing of things) {
    if (!thing.on_way && signed.every((other) => apart(thing, other))) signed.push(thing);
  }
  return signed;
};
