// What the page and the worker that cuts orthophotos into tiles say to each other.

import type { Bounds, TileAddress } from '../model/tiling';

export type Asked =
  /** What is it? */
  | { readonly kind: 'look'; readonly file: File }
  /** Cut it. */
  | { readonly kind: 'cut' }
  /** The last tile was taken: the next one. */
  | { readonly kind: 'next' };

/** How well it is known where the datum of a picture lies. */
export interface OfDatum {
  readonly name: string;
  /** So many metres; null: the file brings its own shift, and does not say. */
  readonly good_to_m: number | null;
}

export interface Looked {
  readonly bounds: Bounds;
  /** null: to a metre, as any picture. */
  readonly datum: OfDatum | null;
  readonly min_zoom: number;
  readonly max_zoom: number;
  /** Tiles of the finest zoom. */
  readonly tiles: number;
  readonly format: 'webp' | 'png';
}

export type OrthoTrouble =
  | 'unreadable'
  | 'no_place'
  | 'no_projection'
  | 'no_datum'
  | 'other_axes'
  | 'not_8_bit'
  | 'too_large';

export type Told =
  | { readonly kind: 'looked'; readonly is: Looked }
  | {
      readonly kind: 'tile';
      readonly at: TileAddress;
      readonly picture: Blob;
      readonly done: number;
    }
  | { readonly kind: 'whole' }
  | { readonly kind: 'trouble'; readonly why: OrthoTrouble; readonly detail: string };
