// Draws how the loaded mission is to be driven: where another speed begins, and where the robot turns on
// the spot.

import { pivots_ahead, type DriveOnMap, type Pivot, type SpeedTag } from '../model/route_drive';
import { leg, type Band } from './band';
import { stand_at, type Paint } from './canvas';
import { palette } from './palette';
import { disc, type DrawnPlan } from './plan_painter';
import { to_plane, to_plane_line, type PlaneLine, type PlanePoint } from './projection';

interface DrawnPivot {
  readonly pivot: Pivot;
  readonly at: PlanePoint;
}
export interface DrawnDrive extends DriveOnMap {
  readonly places: ReadonlyMap<Pivot, PlanePoint>;
  readonly pace_line: PlaneLine;
}

/** @param before what may be drawn of it already */
export const prepare_drive = (drive: DriveOnMap, before: DrawnDrive | null): DrawnDrive => ({
  ...drive,
  pace_line: before?.pace === drive.pace ? before.pace_line : to_plane_line(drive.pace),
  places: new Map(drive.pivots.map((pivot) => [pivot, to_plane(pivot)])),
});

/** From the place to the middle of its mark: beside the number, and the ring around what is next. */
const BESIDE_PX = 32;
const MARK_PX = 13;
/** Nearer to each other they are dots. */
const APART_PX = 34;
const MARKS_MOST = 60;
const DOT_PX = 3.5;
/** How much of the circle the arrow is. */
const SWEEP_RAD = 4.9;
const TAG_HIGH_PX = 20;
const SIGNS_MOST = 40;
/** On their way, best first: where the arrow is not, and no other one. */
const TAG_AT = [0.62, 0.82, 0.2, 0.4];
/** So much of the way is still seen. */
const TAG_LEAVES_PX = 24;

/** An arrow that goes round, the way that the robot turns. */
const paint_mark = (paint: Paint, x: number, y: number, left: boolean): void => {
  const { context } = paint;
  const { ground, sign } = palette();
  disc(context, x, y, MARK_PX);
  context.fillStyle = ground;
  context.fill();
  context.strokeStyle = sign;
  context.lineWidth = 2;
  context.stroke();
  const side = left ? -1 : 1;
  const r = 7;
  // On the screen angles grow clockwise, and this one ends at its top.
  const end = -Math.PI / 2 + side * 0.9;
  context.beginPath();
  context.arc(x, y, r, end - side * SWEEP_RAD, end, left);
  context.lineWidth = 2.5;
  context.lineCap = 'round';
  context.lineJoin = 'round';
  context.stroke();
  const [tip_x, tip_y] = [x + r * Math.cos(end), y + r * Math.sin(end)];
  const heading = end + (side * Math.PI) / 2;
  context.beginPath();
  for (const back of [2.4, -2.4]) {
    context.moveTo(tip_x, tip_y);
    context.lineTo(tip_x + 6 * Math.cos(heading + back), tip_y + 6 * Math.sin(heading + back));
  }
  context.stroke();
};

const in_sight = ({ width_px, height_px }: Paint, x: number, y: number): boolean =>
  x > -50 && y > -50 && x < width_px + 50 && y < height_px + 50;

interface Seen {
  readonly pivot: Pivot;
  readonly x: number;
  readonly y: number;
}

/** Has it room on the screen? Else it is a dot: none is left out. */
const stands_alone = (seen: readonly Seen[], mark: Seen): boolean =>
  seen.length <= MARKS_MOST &&
  seen.every(
    (other) => other === mark || Math.hypot(other.x - mark.x, other.y - mark.y) >= APART_PX,
  );

const paint_dots = (paint: Paint, dots: readonly Seen[]): void => {
  const { context } = paint;
  const { ground, sign } = palette();
  context.beginPath();
  for (const { x, y } of dots) context.rect(x - DOT_PX, y - DOT_PX, 2 * DOT_PX, 2 * DOT_PX);
  context.fillStyle = sign;
  context.strokeStyle = ground;
  context.lineWidth = 2;
  context.stroke();
  context.fill();
};

const paint_pivots = (paint: Paint, pivots: readonly DrawnPivot[]): void => {
  const seen = pivots.flatMap(({ pivot, at }): Seen[] => {
    const [x, y] = [paint.x_px(at[0]), paint.y_px(at[1])];
    return in_sight(paint, x, y) ? [{ pivot, x, y }] : [];
  });
  const marks = seen.filter((each) => stands_alone(seen, each));
  paint_dots(
    paint,
    seen.filter((each) => !marks.includes(each)),
  );
  for (const { pivot, x, y } of marks) {
    const [east, north] = [Math.cos(pivot.outside_rad), Math.sin(pivot.outside_rad)];
    paint_mark(paint, x + BESIDE_PX * east, y - BESIDE_PX * north, pivot.left);
  }
};

/** Where a sign stands on the screen. */
interface Sign {
  readonly x: number;
  readonly y: number;
  readonly wide_px: number;
  readonly text: string;
}

const overlap = (a: Sign, b: Sign): boolean =>
  Math.abs(a.x - b.x) < (a.wide_px + b.wide_px) / 2 + 2 && Math.abs(a.y - b.y) < TAG_HIGH_PX + 2;

/** @param k of the spot it leads to. @return null: there is no room */
const sign_on = (
  paint: Paint,
  band: Band,
  { k, text }: SpeedTag,
  others: readonly Sign[],
): Sign | null => {
  const [from, to] = leg(band, k);
  const [x0, y0] = [paint.x_px(from[0]), paint.y_px(from[1])];
  const [dx, dy] = [paint.x_px(to[0]) - x0, paint.y_px(to[1]) - y0];
  const long_px = Math.hypot(dx, dy);
  const wide_px = paint.context.measureText(text).width + 12;
  const under_px = (Math.abs(dx) * wide_px + Math.abs(dy) * TAG_HIGH_PX) / long_px;
  if (!(long_px >= under_px + TAG_LEAVES_PX)) return null;
  const all = TAG_AT.map((share) => ({ x: x0 + share * dx, y: y0 + share * dy, wide_px, text }));
  return (
    all.find(
      (sign) => in_sight(paint, sign.x, sign.y) && !others.some((other) => overlap(sign, other)),
    ) ?? null
  );
};

/** The figure reads whatever the colours are. */
const paint_sign = (paint: Paint, { x, y, wide_px, text }: Sign): void => {
  const { context } = paint;
  const { ground, sign } = palette();
  context.save();
  stand_at(paint, x, y);
  context.beginPath();
  context.roundRect(-wide_px / 2, -TAG_HIGH_PX / 2, wide_px, TAG_HIGH_PX, 5);
  context.fillStyle = ground;
  context.fill();
  context.strokeStyle = sign;
  context.lineWidth = 1.5;
  context.stroke();
  context.fillStyle = sign;
  context.fillText(text, 0, 0.5);
  context.restore();
};

const paint_signs = (paint: Paint, band: Band, tags: readonly SpeedTag[]): void => {
  const { context } = paint;
  context.font = '700 14px system-ui, sans-serif';
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  const signs: Sign[] = [];
  for (const tag of tags) {
    if (signs.length >= SIGNS_MOST) return;
    const sign = sign_on(paint, band, tag, signs);
    if (!sign) continue;
    signs.push(sign);
    paint_sign(paint, sign);
  }
};

/** @param current_item from 1; 0: none: of what is done nothing is told */
export const paint_drive = (
  paint: Paint,
  { spots, band }: DrawnPlan,
  drive: DrawnDrive,
  current_item: number,
): void => {
  paint_pivots(
    paint,
    pivots_ahead(drive.pivots, current_item).flatMap((pivot) => {
      const at = drive.places.get(pivot);
      return at ? [{ pivot, at }] : [];
    }),
  );
  const ahead = drive.tags.filter(({ k }) => (spots[k]?.index ?? -2) + 1 >= current_item);
  paint_signs(paint, band, ahead);
};
