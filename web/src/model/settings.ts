// How this device shows things: chosen by whoever holds it, kept on it, and nothing of the robot's.

import { number_text } from './format';
import { PAD_DEFAULTS, pad_settings_of, type PadSettings } from './gamepad';
import type { PlaceForm } from './place_text';

/** Sunlight: black on white, whatever the device prefers. */
export type Look = 'device' | 'sunlight';
export type SpeedUnit = 'm/s' | 'km/h';

export interface Settings {
  readonly look: Look;
  readonly speed: SpeedUnit;
  readonly places: PlaceForm;
  readonly gamepad: PadSettings;
}

export const DEFAULTS: Settings = {
  look: 'device',
  speed: 'm/s',
  places: 'degrees',
  gamepad: PAD_DEFAULTS,
};

export const LOOKS: readonly Look[] = ['device', 'sunlight'];
export const SPEED_UNITS: readonly SpeedUnit[] = ['m/s', 'km/h'];
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
  const { look, speed, places, gamepad } = kept_in(text);
  return {
    look: one_of(LOOKS, look, DEFAULTS.look),
    speed: one_of(SPEED_UNITS, speed, DEFAULTS.speed),
    places: one_of(PLACE_FORMS, places, DEFAULTS.places),
    gamepad: pad_settings_of(gamepad),
  };
};

const KMH_PER_MPS = 3.6;

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
