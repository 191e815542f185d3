// The map's own drawing above the tiles, on canvases that lie on each other:
//
//   ground   what moves and lies under everything (how sure the robot is of place and heading, what it
//            sees)
//   still    what stays where it is: grid, fence, route, way so far; and on a canvas of its own, for it
//            changes alone, the mission that is edited. Drawn once with a margin around the screen, then
//            only moved (still.ts)
//   target   where the mission is driven to: it changes with every item, and lies far from the robot
//   moving   the robot, the last metres it drove, a point that is dragged
//   above    what stands at the border of the screen
//
// Where heading is up all but the last lie on a paper that is turned as one: no painter knows of it but
// those that write. What moves is drawn ten times a second on a canvas just as large as it needs: a canvas
// costs by its pixels.

import Layer from 'ol/layer/Layer';

import { Moving, view_of, type Mover, type View } from './canvas';
import { Still, type Stays } from './still';

/** What is drawn, and when. */
export interface Drawing {
  /** From below. */
  readonly still: readonly Stays[];
  ground(view: View): readonly Mover[];
  target(view: View): readonly Mover[];
  moving(view: View): readonly Mover[];
  /** Places of the screen, whichever way the map is turned. */
  above(view: View): readonly Mover[];
  /** Beside it, what does not move with the map. @param again what stays was drawn again */
  beside(view: View, again: boolean): readonly HTMLElement[];
}

const laid_over = (style: Partial<CSSStyleDeclaration>): HTMLDivElement => {
  const box = document.createElement('div');
  Object.assign(box.style, { position: 'absolute', inset: '0', pointerEvents: 'none', ...style });
  return box;
};

/** Lays the paper around the screen's middle, turned. @param last as it lay in the frame before */
const lay = (paper: HTMLElement, view: View, last: View | null): void => {
  const { turn_rad, width_px, height_px, screen } = view;
  const same = last?.width_px === width_px && last.height_px === height_px;
  if (same && last.turn_rad === turn_rad) return;
  const aside = (paper_px: number, screen_px: number): number => (screen_px - paper_px) / 2;
  Object.assign(
    paper.style,
    turn_rad === 0
      ? { inset: '0', transform: '' }
      : {
          inset: `${aside(height_px, screen.height_px)}px ${aside(width_px, screen.width_px)}px`,
          transform: `rotate(${turn_rad}rad)`,
        },
  );
};

/** The screen itself as what is painted on. */
const upright_view = (view: View): View =>
  view.turn_rad === 0 ? view : { ...view, ...view.screen, turn_rad: 0 };

export const canvas_layer = (drawing: Drawing): Layer => {
  // Words that a drag has marked are dragged themselves by the next one, and the map stands still.
  const box = laid_over({ overflow: 'hidden', userSelect: 'none', webkitUserSelect: 'none' });
  const paper = laid_over({});
  const [ground, target] = [new Moving(), new Moving()];
  const stills = drawing.still.map((stays) => new Still(stays));
  const [moving, above] = [new Moving(), new Moving()];
  const still_boxes = stills.map((still) => still.box);
  paper.append(ground.sheet.canvas, ...still_boxes, target.sheet.canvas, moving.sheet.canvas);
  box.append(paper, above.sheet.canvas);
  let last: View | null = null;
  const layer: Layer = new Layer({
    render: (frame) => {
      const view = view_of(frame);
      lay(paper, view, last);
      last = view;
      const budget = { pieces: 1 };
      let again = false;
      for (const still of stills) again = still.step(view, budget) || again;
      if (stills.some((still) => still.begun)) layer.changed(); // the next piece, with the next frame
      ground.draw(view, drawing.ground(view));
      target.draw(view, drawing.target(view));
      moving.draw(view, drawing.moving(view));
      above.draw(upright_view(view), drawing.above(view));
      for (const element of drawing.beside(view, again)) {
        if (element.parentNode !== box) box.append(element);
      }
      return box;
    },
  });
  return layer;
};
