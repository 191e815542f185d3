// What is kept of each change of a stored mission.

/** A change of a stored mission. */
export interface Revision {
  readonly revision: number;
  readonly time: string;
  readonly author: string;
  /** "replaced", "reverted to 3". */
  readonly what: string;
  readonly deletion: boolean;
  readonly name: string;
  readonly items: number;
  readonly length_m: number;
}
