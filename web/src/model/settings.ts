// How this device shows things: chosen by whoever holds it, kept on it, and nothing of the robot's.

import { CUE_DEFAULTS, cue_settings_of, type CueSettings } from './cues';
import { number_text } from './format';
import { PAD_DEFAULTS, pad_settings_of, type PadSettings } from './gamepad';
import { instruments_of, type Instrument } from './instruments';
import type { MapUp } from './map_up';
import type { PlaceForm } from './place_text';
import { LANGUAGES, language_of, type Language } from './say';

/** Sunlight: black on white, whatever the device prefers. */
export type Look = 'device' | 'sunlight';
export type SpeedUnit = 'm/s' | 'km/h';
/** What the colour of the way so far tells. */
export type TrailBy = 'plain' | 'deviation' | 'speed';

export interface Settings {
  /** Null: the one that the device asks for. */
  readonly language: Language | null;
  readonly look: Look;
  readonly speed: SpeedUnit;
  readonly places: PlaceForm;
  readonly trail: TrailBy;
  readonly map_up: MapUp;
  readonly gamepad: PadSettings;
  readonly instruments: readonly Instrument[];
  readonly cues: CueSettings;
}

export const DEFAULTS: Settings = {
  language: null,
  look: 'device',
  speed: 'm/s',
  places: 'degrees',
  trail: 'plain',
  map_up: 'north',
  gamepad: PAD_DEFAULTS,
  instruments: ['compass', 'deviation'],
  cues: CUE_DEFAULTS,
};

export const LOOKS: readonly Look[] = ['device', 'sunlight'];
export const SPEED_UNITS: readonly SpeedUnit[] = ['m/s', 'km/h'];
export const MAP_UPS: readonly MapUp[] = ['north', 'heading'];
export const TRAIL_BY: readonly TrailBy[] = ['plain', 'deviation', 'speed'];
export const PLACE_FORMS: readonly PlaceForm[] = ['degrees', 'dms', 'utm'];

const one_of = <T>(all: readonly T[], value: unknown, otherwise: T): T =>
  all.find((each) => each === value) ?? otherwise;

const kept_in = (text: string | null): Readonly<Record<string, unknown>> => {
  try {
    const kept: unknown = JSON.parse(text ?? 'null');
    return typeof kept === 'object' && kept !== null ? { ...kept } : {};
  } catch {
    return {};
  }
};

/** What was kept. Whatever it does not know, or nobody wrote like that, is as at first. */
export const settings_of = (text: string | null): Settings => {
  const { language, look, speed, places, trail, map_up, gamepad, instruments, cues } =
    kept_in(text);
  return {
    language: one_of<Language | null>(LANGUAGES, language, DEFAULTS.language),
    look: one_of(LOOKS, look, DEFAULTS.look),
    speed: one_of(SPEED_UNITS, speed, DEFAULTS.speed),
    places: one_of(PLACE_FORMS, places, DEFAULTS.places),
    trail: one_of(TRAIL_BY, trail, DEFAULTS.trail),
    map_up: one_of(MAP_UPS, map_up, DEFAULTS.map_up),
    gamepad: pad_settings_of(gamepad),
    instruments: instruments_of(instruments, DEFAULTS.instruments),
    cues: cue_settings_of(cues),
  };
};

/** What is spoken. @param wished what the device asks for, best first */
export const language_in = ({ language }: Settings, wished: readonly string[]): Language =>
  language ?? language_of(wished);

const KMH_PER_MPS = 3.6;

/** A speed is shown and typed in the unit of this device; what is kept and sent is m/s. Other units stay.
 * @return how many of them one of `unit` is */
export const shown_per = (unit: string, speed: SpeedUnit): number =>
  unit === 'm/s' && speed === 'km/h' ? KMH_PER_MPS : 1;
export const shown_unit = (unit: string, speed: SpeedUnit): string =>
  unit === 'm/s' ? speed : unit;
/** Finer than anybody types; 0.5 m/s is "1.8", not "1.7999". */
export const rounded_shown = (value: number): number => Number(value.toFixed(4));

/** "0.80 m/s", or "2.9 km/h": there a digit less is as fine. @param digits of m/s */
export const speed_text = (
  speed_mps: number | null | undefined,
  unit: SpeedUnit,
  digits = 2,
): string =>
  unit === 'm/s'
    ? number_text(speed_mps, digits, unit)
    : number_text(
        typeof speed_mps === 'number' ? speed_mps * KMH_PER_MPS : speed_mps,
        Math.max(0, digits - 1),
        unit,
      );
