// What lies beneath everything: tiles of pictures, or of lines and areas (vector tiles), moved by
// as much as they lie beside.

import type OlMap from 'ol/Map';
import type Layer from 'ol/layer/Layer';
import TileLayer from 'ol/layer/Tile';
import XYZ from 'ol/source/XYZ';
import TileGrid from 'ol/tilegrid/TileGrid';
import { HALF_SIZE } from 'ol/proj/epsg3857';

import type { Ground } from '../model/ground';
import { TILE_PX } from '../model/tiling';
import { plain_text } from './plain_text';
import { to_plane, units_per_m } from './projection';

const resolutions = (max_zoom: number): number[] =>
  Array.from({ length: max_zoom + 1 }, (_, z) => (2 * HALF_SIZE) / TILE_PX / 2 ** z);

/** Where it lies in the plane: a metre there is longer than on the ground. */
const placed = (
  ground: Ground,
): { readonly origin: [number, number]; readonly extent?: [number, number, number, number] } => {
  const { bounds, shift_m } = ground;
  const lat = bounds ? (bounds.south + bounds.north) / 2 : 0;
  const units = units_per_m(lat);
  const [dx, dy] = [shift_m[0] * units.east, shift_m[1] * units.north];
  const origin: [number, number] = [-HALF_SIZE + dx, HALF_SIZE + dy];
  if (!bounds) return { origin };
  const [west, south] = to_plane({ lat: bounds.south, lon: bounds.west });
  const [east, north] = to_plane({ lat: bounds.north, lon: bounds.east });
  return { origin, extent: [west + dx, south + dy, east + dx, north + dy] };
};

export const grid_of = (ground: Ground): TileGrid => {
  const { origin, extent } = placed(ground);
  return new TileGrid({
    origin,
    resolutions: resolutions(ground.max_zoom),
    minZoom: Math.min(ground.min_zoom, ground.max_zoom),
    tileSize: TILE_PX,
    // Rows from the south are counted from its edge.
    extent: extent ?? [-HALF_SIZE, -HALF_SIZE, HALF_SIZE, HALF_SIZE],
  });
};

/** So many in a row that do not come: a single one may be missing where the others are. */
const SILENT_AFTER = 4;

/** @param told hears whether no picture comes */
const of_pictures = (ground: Ground, told: (silent: boolean) => void): Layer => {
  const { extent } = placed(ground);
  const source = new XYZ({
    url: ground.url,
    tileGrid: grid_of(ground),
    wrapX: false,
    ...(ground.url.startsWith('/') ? {} : { crossOrigin: 'anonymous' }),
  });
  let failed = 0;
  source.on('tileloaderror', () => {
    failed += 1;
    if (failed === SILENT_AFTER) told(true);
  });
  source.on('tileloadend', () => {
    if (failed >= SILENT_AFTER) told(false);
    failed = 0;
  });
  return new TileLayer({ source, ...(extent ? { extent } : {}) });
};

/** Few robots have vector tiles: their part of the library comes when it is needed. */
const ground_layer = async (ground: Ground, told: (silent: boolean) => void): Promise<Layer> => {
  if (!ground.vector) return of_pictures(ground, told);
  const { vector_layer } = await import('./vector_ground');
  return vector_layer(ground.url, grid_of(ground));
};

export class GroundBelow {
  /** Whose pictures they are. */
  readonly credit = document.createElement('div');
  readonly #map: OlMap;
  #shown: Layer | null = null;
  /** Of two grounds the later one counts, whichever comes first. */
  #asked = 0;

  constructor(map: OlMap) {
    this.#map = map;
    this.credit.className = 'map-credit';
  }

  use(ground: Ground | null, told: (silent: boolean) => void): void {
    const asked = ++this.#asked;
    const told_of_this = (silent: boolean): void => {
      if (asked === this.#asked) told(silent);
    };
    told(false);
    this.credit.textContent = ground ? plain_text(ground.attribution) : '';
    void (ground ? ground_layer(ground, told_of_this) : Promise.resolve(null)).then((layer) => {
      if (asked !== this.#asked) return;
      if (this.#shown) this.#map.removeLayer(this.#shown);
      this.#shown = layer;
      if (layer) this.#map.getLayers().insertAt(0, layer);
    });
  }
}
