// Vector tiles, plainly: what they hold is drawn, whatever their makers call it.

import MVT from 'ol/format/MVT';
import VectorTileLayer from 'ol/layer/VectorTile';
import type RenderFeature from 'ol/render/Feature';
import VectorTileSource from 'ol/source/VectorTile';
import Circle from 'ol/style/Circle';
import Fill from 'ol/style/Fill';
import Stroke from 'ol/style/Stroke';
import Style from 'ol/style/Style';
import type TileGrid from 'ol/tilegrid/TileGrid';

const WATER = /water|ocean|lake|river/;
const WOOD = /wood|forest|landcover|park/;
const BUILT = /building/;

const fill = (color: string): Style =>
  new Style({ fill: new Fill({ color }), stroke: new Stroke({ color: '#6b6f6999', width: 0.5 }) });

const AREAS: readonly (readonly [RegExp, Style])[] = [
  [WATER, fill('#9cc3e0b0')],
  [WOOD, fill('#a9c99a90')],
  [BUILT, fill('#b3a8a0c0')],
  [/./, fill('#d8d4c640')],
];
const WATERWAY = new Style({ stroke: new Stroke({ color: '#6ba4cf', width: 1.5 }) });
const LINE = new Style({ stroke: new Stroke({ color: '#7d786e', width: 1.5 }) });
const SPOT = new Style({
  image: new Circle({ radius: 2, fill: new Fill({ color: '#7d786e' }) }),
});

const style_of = (feature: RenderFeature): Style => {
  const layer = String(feature.get('layer') ?? '');
  const kind = feature.getType();
  if (kind === 'Point' || kind === 'MultiPoint') return SPOT;
  if (kind === 'LineString' || kind === 'MultiLineString') {
    return WATER.test(layer) ? WATERWAY : LINE;
  }
  return AREAS.find(([of]) => of.test(layer))?.[1] ?? LINE;
};

export const vector_layer = (url: string, tileGrid: TileGrid): VectorTileLayer<VectorTileSource> =>
  new VectorTileLayer({
    source: new VectorTileSource({ format: new MVT(), url, tileGrid, wrapX: false }),
    style: (feature) => style_of(feature as RenderFeature),
  });
