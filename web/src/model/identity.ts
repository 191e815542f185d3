// By what people tell this robot from others.

export interface RobotIdentity {
  readonly name: string;
  /** `kask.local`; null: the networks are not told. */
  readonly host: string | null;
  /** Of the list in the interface; white stands out on it. */
  readonly rgb: string;
  /** Path on this server. */
  readonly picture: string;
}

export const title_of = (robot: RobotIdentity | null): string =>
  robot ? `${robot.name} – roverd` : 'roverd';
