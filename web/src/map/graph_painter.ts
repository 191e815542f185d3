// Draws the graph of nodes along which ways are planned: its links as lines, an arrow in the middle of one
// that leads one way only, its nodes as discs with their numbers where there is room for them.

import type { GraphOnMap } from '../model/node_graph';
import { stand_at, stroke_cased, type Paint } from './canvas';
import type { Palette } from './palette';
import { to_plane, type PlanePoint } from './projection';

interface DrawnNode {
  readonly at: PlanePoint;
  readonly name: string;
  readonly home: boolean;
}
interface DrawnLink {
  readonly from: PlanePoint;
  readonly to: PlanePoint;
  readonly one_way: boolean;
}
interface DrawnGraph {
  readonly nodes: readonly DrawnNode[];
  readonly links: readonly DrawnLink[];
}

const NODE_PX = 5;
const HOME_PX = 8;
const ARROW_PX = 7;
const NAME_PX = 24;
/** More in sight are a carpet of numbers. */
const MOST_NAMES = 150;

const prepare_graph = ({ nodes, links }: GraphOnMap): DrawnGraph => ({
  nodes: nodes.map((node) => ({ at: to_plane(node), name: String(node.id), home: node.home })),
  links: links.map(({ from, to, one_way }) => ({
    from: to_plane(from),
    to: to_plane(to),
    one_way,
  })),
});

/** The last one: it changes seldom, and is drawn at every frame. */
let kept: { graph: GraphOnMap; drawn: DrawnGraph } | null = null;

const drawn_of = (graph: GraphOnMap): DrawnGraph => {
  if (kept?.graph !== graph) kept = { graph, drawn: prepare_graph(graph) };
  return kept.drawn;
};

const paint_links = (paint: Paint, links: readonly DrawnLink[], colors: Palette): void => {
  const { context, width_px, height_px } = paint;
  context.beginPath();
  for (const { from, to, one_way } of links) {
    const [x0, y0] = [paint.x_px(from[0]), paint.y_px(from[1])];
    const [x1, y1] = [paint.x_px(to[0]), paint.y_px(to[1])];
    if (Math.max(x0, x1) < 0 || Math.max(y0, y1) < 0) continue;
    if (Math.min(x0, x1) > width_px || Math.min(y0, y1) > height_px) continue;
    context.moveTo(x0, y0);
    context.lineTo(x1, y1);
    if (!one_way) continue;
    const [x, y] = [(x0 + x1) / 2, (y0 + y1) / 2];
    const to_rad = Math.atan2(y1 - y0, x1 - x0);
    for (const side of [-0.8, 0.8]) {
      context.moveTo(x, y);
      context.lineTo(
        x - ARROW_PX * Math.cos(to_rad + side),
        y - ARROW_PX * Math.sin(to_rad + side),
      );
    }
  }
  stroke_cased(context, colors.casing, colors.home, 2);
};

export const paint_graph = (paint: Paint, graph: GraphOnMap, colors: Palette): void => {
  const { nodes, links } = drawn_of(graph);
  const { context, width_px, height_px } = paint;
  context.save();
  paint_links(paint, links, colors);
  const seen = nodes
    .map((node) => ({ ...node, x: paint.x_px(node.at[0]), y: paint.y_px(node.at[1]) }))
    .filter(({ x, y }) => x > -NAME_PX && y > -NAME_PX)
    .filter(({ x, y }) => x < width_px + NAME_PX && y < height_px + NAME_PX);
  context.beginPath();
  for (const { x, y, home } of seen) {
    const radius = home ? HOME_PX : NODE_PX;
    context.moveTo(x + radius, y);
    context.arc(x, y, radius, 0, 2 * Math.PI);
  }
  context.fillStyle = colors.home;
  context.fill();
  context.lineWidth = 1.5;
  context.strokeStyle = colors.casing;
  context.stroke();
  context.font = '600 12px system-ui, sans-serif';
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.lineWidth = 3;
  context.fillStyle = colors.home;
  for (const { x, y, name } of seen.length > MOST_NAMES ? [] : seen) {
    context.save();
    stand_at(paint, x, y);
    context.strokeText(name, 0, NAME_PX);
    context.fillText(name, 0, NAME_PX);
    context.restore();
  }
  context.restore();
};
