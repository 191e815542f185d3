// What the vehicle can do and what it is like, as the robot tells it when the stream opens.

import type { GuardFigures } from './sweep';
import type { Mode } from './vehicle';

export interface Capabilities {
  /** Of the server. */
  readonly version: string;
  readonly vehicle: string;
  /** Name for people. */
  readonly title: string;
  readonly kinematics: string;
  readonly size: { readonly length_m: number; readonly width_m: number; readonly mass_kg: number };
  readonly limits: {
    readonly max_speed_mps: number;
    readonly max_yaw_rate_dps: number;
    readonly max_acceleration_mps2: number;
    /** Corners sharper than this are turned on the spot. */
    readonly pivot_angle_deg: number;
  };
  /** What the positions of the radio's switches do: `swc_up` is `mode.manual`. */
  readonly radio: Readonly<Record<string, string>>;
  readonly drivers: readonly string[];
  /** Null: it has no sensors that look around. */
  readonly guard: GuardFigures | null;
  readonly modes: readonly Mode[];
  readonly item_types: readonly string[];
  readonly import_formats: readonly string[];
  readonly export_formats: readonly string[];
}
