// The plane that a GeoTIFF is drawn in, by its keys (OGC 19-008r4): degrees to it, and back.

import { toProj4 } from 'geotiff-geokeys-to-proj4';
import proj4 from 'proj4';

import { distance_m } from '../model/geo';
import { datum_of, shifts_at, type Datum, type Shift } from './datum';
import type { OfDatum } from './messages';
import { Trouble } from './trouble';

/** By their names, those that are used by name here. */
export interface Keys {
  readonly [name: string]: unknown;
  readonly GTModelTypeGeoKey?: unknown;
  readonly GTRasterTypeGeoKey?: unknown;
  readonly GTCitationGeoKey?: unknown;
  readonly PCSCitationGeoKey?: unknown;
  readonly ProjStdParallel1GeoKey?: unknown;
  readonly GeogCitationGeoKey?: unknown;
  readonly GeodeticCitationGeoKey?: unknown;
  readonly GeogTOWGS84GeoKey?: unknown;
}

/** Degrees of WGS 84 to the units of the picture's plane, and back. */
export interface Plane {
  forward(lon: number, lat: number): [x: number, y: number];
  inverse(x: number, y: number): [lon: number, lat: number];
  /** null: it lies as exactly as the picture */
  readonly datum: OfDatum | null;
}

const USER_DEFINED = 32767;
const GEOGRAPHIC = 2;
const WEB_MERCATOR = 3857;
const MERCATOR = 7;
const SOUTH_ORIENTED = 27;
/** Methods of projections that a file defines itself, by which the library lays it as PROJ does. */
const METHODS = [1, MERCATOR, 8, 9, 10, 11, 12, 13, 16, 18, 22, 24, 28];
/** A picture lies in more than one area, and the shifts differ by more: none of them is believed. */
const MOST_DOUBT_M = 10;

const code_of = (keys: Keys, ...names: string[]): number | null => {
  const code = names.map((name) => keys[name]).find((value) => value !== undefined);
  return typeof code === 'number' && code > 0 && code !== USER_DEFINED ? code : null;
};

/** What a geographic system's own code defines. */
const OF_DATUM =
  /^(Geog)?(GeodeticDatum|Ellipsoid|SemiM|InvFlattening|PrimeMeridian|TOWGS84)|^Vertical/;

/**
 * Without what a system's code defines already, but for the units of the plane: many writers name the
 * geographic system beside the projected one, and all of it in words. Heights do not matter.
 */
const asked_of = (keys: Keys, projected: number | null, geographic: number | null): Keys => {
  const kept = (name: string): boolean => {
    if (projected !== null) return /^(ProjectedC|ProjLinearUnit)/.test(name);
    if (name.startsWith('Projected') || name.startsWith('Vertical')) return false;
    if (name.startsWith('Proj') && keys.GTModelTypeGeoKey === GEOGRAPHIC) return false;
    return geographic !== null ? !OF_DATUM.test(name) : !/^(Geographic|GeodeticCRS)/.test(name);
  };
  return Object.fromEntries(Object.entries(keys).filter(([name]) => kept(name)));
};

/** As the file calls a datum that no table knows. */
const name_of = (keys: Keys, code: number | null): string => {
  const said = keys.GeogCitationGeoKey ?? keys.GeodeticCitationGeoKey;
  const parts = typeof said === 'string' ? said.split('|') : [];
  const own = parts.find((part) => part.startsWith('Datum = ')) ?? parts[0] ?? '';
  const words = [own.replace('Datum = ', ''), code === null ? '' : `EPSG:${code}`];
  return words.filter((word) => word !== '').join(', ');
};

/** A sphere's Mercator in words: what is not said by its keys would lie 36 km off. */
const is_web_mercator = (keys: Keys): boolean =>
  [keys.GTCitationGeoKey, keys.PCSCitationGeoKey].some((words) =>
    /Pseudo-Mercator|Mercator_Auxiliary_Sphere/.test(String(words)),
  );

/** The library lays some projections elsewhere that a file defines itself. @throws Trouble */
const refuse_unsure = (keys: Keys): void => {
  const method = code_of(keys, 'ProjMethodGeoKey', 'ProjCoordTransGeoKey');
  if (method === SOUTH_ORIENTED) throw new Trouble('other_axes');
  const other_scale = method === MERCATOR && (keys.ProjStdParallel1GeoKey ?? 0) !== 0;
  if (method !== null && (!METHODS.includes(method) || other_scale)) {
    throw new Trouble('no_projection', `ProjCoordTransGeoKey ${method}`);
  }
  // By their number: those of UTM.
  const conversion = code_of(keys, 'ProjectionGeoKey') ?? 16001;
  if (!/^16[01]([0-5]\d|60)$/.test(String(conversion))) {
    throw new Trouble('no_projection', `ProjectionGeoKey ${conversion}`);
  }
};

/** The code of an older datum's geographic system is that of the datum, less 2000. */
const by_datum = (keys: Keys): number | null => {
  const datum = code_of(keys, 'GeodeticDatumGeoKey', 'GeogGeodeticDatumGeoKey') ?? 0;
  return datum > 6000 && datum < 7000 ? datum - 2000 : null;
};

const towgs84_of = (keys: Keys): readonly number[] | null => {
  const said = keys.GeogTOWGS84GeoKey;
  return Array.isArray(said) || ArrayBuffer.isView(said) ? Array.from(said as number[]) : null;
};

/** What the library says of it, without its shifts (some are no published ones), axes and units. */
const text_of = (keys: Keys): { readonly text: string; readonly unit: number } => {
  const said = toProj4(keys as object as Parameters<typeof toProj4>[0]);
  const troubles = Object.entries(said.errors);
  if (troubles.length > 0 || /\+proj=geocent/.test(said.proj4)) {
    throw new Trouble('no_projection', troubles.map(String).join(' '));
  }
  const tokens = said.proj4.split(/\s+/).filter((token) => token.startsWith('+'));
  const value = (name: string): string | undefined =>
    tokens.find((token) => token.startsWith(`+${name}=`))?.split('=')[1];
  if (/[ws]/.test(value('axis') ?? '')) throw new Trouble('other_axes');
  const { x } = said.coordinatesConversionParameters;
  // Its own unit is said here or there, never in both: to_meter would be one more time.
  const own = x === 1 && code_of(keys, 'ProjLinearUnitsGeoKey') === null ? value('to_meter') : x;
  const text = tokens.filter(
    (token) => !/^\+(towgs84|datum|nadgrids|axis|to_meter|units|no_defs)\b/.test(token),
  );
  return { text: `${text.join(' ')} +no_defs`, unit: Number(own ?? 1) };
};

const shifted = (text: string, { towgs84 }: Pick<Shift, 'towgs84'>): proj4.Converter => {
  try {
    return proj4('WGS84', towgs84.length === 0 ? text : `${text} +towgs84=${towgs84.join()}`);
  } catch (cause) {
    throw new Trouble('no_projection', cause instanceof Error ? cause.message : String(cause));
  }
};

/** The best shift there, and how good it is: where areas overlap the others may be true as well. */
const chosen = (text: string, datum: Datum, x: number, y: number): [Shift, number] => {
  const at = (shift: Pick<Shift, 'towgs84'>): { lat: number; lon: number } => {
    const [lon = Number.NaN, lat = Number.NaN] = shifted(text, shift).inverse([x, y]);
    return { lat, lon };
  };
  const raw = at({ towgs84: [] });
  const [best, ...others] = shifts_at(datum, raw.lon, raw.lat);
  if (!best) throw new Trouble('no_datum', datum.name);
  const doubt = Math.max(0, ...others.map((other) => distance_m(at(best), at(other))));
  if (doubt > MOST_DOUBT_M) throw new Trouble('no_datum', datum.name);
  return [best, Math.max(best.good_to_m, doubt)];
};

const projected_of = (keys: Keys, geographic: number | null): number | null => {
  if (keys.GTModelTypeGeoKey === GEOGRAPHIC && geographic !== null) return null;
  const code = code_of(keys, 'ProjectedCRSGeoKey', 'ProjectedCSTypeGeoKey');
  return code ?? (is_web_mercator(keys) ? WEB_MERCATOR : null);
};

/**
 * @param keys of the file, by their names
 * @param middle of the picture, in the units of its plane
 * @throws Trouble
 */
export const plane_of = (keys: Keys, middle: readonly [x: number, y: number]): Plane => {
  const geographic = code_of(keys, 'GeodeticCRSGeoKey', 'GeographicTypeGeoKey');
  const projected = projected_of(keys, geographic);
  const asked = asked_of(keys, projected, geographic);
  refuse_unsure(asked);
  const { text, unit } = text_of(
    projected === WEB_MERCATOR ? { ...asked, ProjectedCSTypeGeoKey: projected } : asked,
  );
  const own = projected ?? geographic;
  const towgs84 = own === null ? towgs84_of(keys) : null;
  const code = own ?? by_datum(keys);
  let shift: Pick<Shift, 'towgs84'>;
  let datum: OfDatum | null;
  if (towgs84) {
    shift = { towgs84: towgs84.some((part) => part !== 0) ? towgs84 : [] };
    datum = { name: 'TOWGS84', good_to_m: null };
  } else {
    const known = code === null ? null : datum_of(code);
    if (!known) throw new Trouble('no_datum', name_of(keys, code));
    const [best, good_to_m] = chosen(text, known, middle[0] * unit, middle[1] * unit);
    shift = best;
    datum = good_to_m > 1 ? { name: known.name, good_to_m: Math.ceil(good_to_m) } : null;
  }
  const { forward, inverse } = shifted(text, shift);
  return {
    datum,
    forward: (lon, lat) => {
      const [x = Number.NaN, y = Number.NaN] = forward([lon, lat]);
      return [x / unit, y / unit];
    },
    inverse: (x, y) => {
      const [lon = Number.NaN, lat = Number.NaN] = inverse([x * unit, y * unit]);
      return [lon, lat];
    },
  };
};
