// What files are, that were dropped onto the page, by their names.

const GROUND = /\.(mbtiles|tiff?|gtiff)$/i;
/** Of the plane: a description and its picture. In three dimensions: points. */
const MAP = /\.(ya?ml|pgm|png|pcd)$/i;

export interface Dropped<F> {
  readonly missions: readonly F[];
  readonly maps: readonly F[];
  /** Of the ground: map tiles and orthophotos. */
  readonly grounds: readonly F[];
}

/** Whatever is no map may be a mission: the robot tells, and why not. */
export const sorted_files = <F extends { readonly name: string }>(
  files: readonly F[],
): Dropped<F> => ({
  missions: files.filter(({ name }) => !MAP.test(name) && !GROUND.test(name)),
  maps: files.filter(({ name }) => MAP.test(name)),
  grounds: files.filter(({ name }) => GROUND.test(name)),
});
