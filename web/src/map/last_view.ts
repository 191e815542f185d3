// Where the map was last looked at, on this device: where no robot says where it is, the map begins there
// instead of showing the world.

import type OlMap from 'ol/Map';

import type { DraftStorage } from '../model/ports';
import { from_plane, to_plane } from './projection';

/** Farther out nobody worked: that is the map before anything is known. */
const LEAST_ZOOM = 8;
/** The map follows the robot: not at every step. */
const WRITE_AFTER_MS = 3000;

const parse = (text: string | null): readonly [lon: number, lat: number, zoom: number] | null => {
  const [lon = NaN, lat = NaN, zoom = NaN] = (text ?? '').split(' ').map(Number);
  const good = Math.abs(lon) <= 180 && Math.abs(lat) <= 85 && zoom >= LEAST_ZOOM && zoom <= 30;
  return good ? [lon, lat, zoom] : null;
};

export const keep_view = (map: OlMap, storage: DraftStorage): void => {
  const view = map.getView();
  const last = parse(storage.read());
  if (last) {
    view.setCenter([...to_plane({ lon: last[0], lat: last[1] })]);
    view.setZoom(last[2]);
  }
  const write = (): void => {
    const { lat, lon } = from_plane(view.getCenter() ?? [0, 0]);
    const zoom = view.getZoom() ?? 0;
    if (zoom >= LEAST_ZOOM) storage.write(`${lon.toFixed(7)} ${lat.toFixed(7)} ${zoom.toFixed(2)}`);
  };
  let timer: ReturnType<typeof setTimeout> | undefined;
  map.on('moveend', () => {
    timer ??= setTimeout(() => {
      timer = undefined;
      write();
    }, WRITE_AFTER_MS);
  });
};
