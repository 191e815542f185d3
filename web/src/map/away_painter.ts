// Points to the robot when it is out of sight: an arrow at the border of the free part of the map, and
// how far it is from the middle of it.

import { edge_spot, type EdgeSpot } from '../model/edge';
import { metres } from '../model/format';
import { distance_m } from '../model/geo';
import type { RobotOnMap } from '../model/ports';
import { on_screen_px, type Paint, type View } from './canvas';
import type { Cover } from './grid';
import type { Palette } from './palette';
import { from_plane, to_plane } from './projection';

const MARGIN_PX = 30;
/** Beside the buttons, which stand at the right, and above the stop button of a laptop. */
const BUTTONS_PX = 96;
const BACK_PX = 26;
const SIZE_PX = 15;

/** Where the arrow stands; null: the robot is in sight. */
export const away_spot = (view: View, robot: RobotOnMap, cover: Cover): EdgeSpot | null => {
  const [x_px, y_px] = on_screen_px(view, to_plane(robot.at));
  const seen = {
    left: cover.left,
    top: cover.top,
    right: view.screen.width_px - cover.right,
    bottom: view.screen.height_px - cover.bottom,
  };
  if (edge_spot(seen, x_px, y_px) === null) return null;
  return edge_spot(
    {
      left: seen.left + MARGIN_PX,
      top: seen.top + MARGIN_PX,
      right: seen.right - BUTTONS_PX,
      bottom: seen.bottom - MARGIN_PX,
    },
    x_px,
    y_px,
  );
};

export const paint_away = (
  paint: Paint,
  robot: RobotOnMap,
  spot: EdgeSpot,
  colors: Palette,
): void => {
  const { context } = paint;
  const color = robot.stale ? colors.robot_stale : colors.robot;
  context.translate(spot.x, spot.y);
  context.rotate(spot.angle_rad);
  context.beginPath();
  context.moveTo(SIZE_PX, 0);
  context.lineTo(-SIZE_PX, SIZE_PX);
  context.lineTo(-SIZE_PX * 0.5, 0);
  context.lineTo(-SIZE_PX, -SIZE_PX);
  context.closePath();
  context.lineJoin = 'round';
  context.strokeStyle = colors.casing;
  context.lineWidth = 6;
  context.stroke();
  context.fillStyle = color;
  context.fill();
  context.rotate(-spot.angle_rad);
  const words = metres(distance_m(from_plane(paint.center), robot.at));
  const [back_x, back_y] = [-Math.cos(spot.angle_rad), -Math.sin(spot.angle_rad)];
  context.font = '700 14px system-ui, sans-serif';
  context.textAlign = back_x > 0.5 ? 'left' : back_x < -0.5 ? 'right' : 'center';
  context.textBaseline = 'middle';
  context.lineWidth = 4;
  context.strokeText(words, back_x * BACK_PX, back_y * BACK_PX);
  context.fillText(words, back_x * BACK_PX, back_y * BACK_PX);
};
