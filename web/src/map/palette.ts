// Colours of what is drawn on the canvas. Everything has a casing in the ground's colour, so that it
// stays readable on tiles and in bright sun.

import { TRAIL_DARK, TRAIL_LIGHT, TRAIL_SUNLIGHT } from '../model/trail_colors';

export interface Palette {
  readonly ground: string;
  readonly casing: string;
  readonly grid_major: string;
  readonly grid_minor: string;
  readonly grid_label: string;
  readonly plan: string;
  readonly selected: string;
  readonly refused: string;
  readonly on_point: string;
  readonly route: string;
  readonly route_done: string;
  /** Around the route. */
  readonly corridor: string;
  /** Within the route. */
  readonly way: string;
  /** What is said beside the way. */
  readonly sign: string;
  readonly current: string;
  readonly trail: string;
  /** Of its classes, and last where it is not known. */
  readonly trail_classes: readonly string[];
  readonly fixes: string;
  readonly robot: string;
  readonly robot_stale: string;
  readonly ring: string;
  readonly wedge: string;
  readonly home: string;
  readonly stay_in: string;
  readonly keep_out: string;
  readonly run_a: string;
  readonly run_b: string;
  readonly run_plan: string;
  /** From little to much; told apart by brightness, too. */
  readonly shades: readonly string[];
}

const light: Palette = {
  ground: '#f3f1ea',
  casing: 'rgba(255, 255, 255, 0.92)',
  grid_major: 'rgba(70, 66, 52, 0.30)',
  grid_minor: 'rgba(70, 66, 52, 0.11)',
  grid_label: '#5b5646',
  plan: '#0b57d0',
  selected: '#b8500a',
  refused: '#b3261e',
  on_point: '#ffffff',
  route: '#146c2e',
  route_done: 'rgba(20, 108, 46, 0.35)',
  corridor: 'rgba(46, 160, 90, 0.16)',
  way: '#06260f',
  sign: '#0c3018',
  current: '#e8710a',
  trail: '#a8327a',
  trail_classes: TRAIL_LIGHT,
  fixes: '#8a6d00',
  robot: '#111318',
  robot_stale: '#8a8d93',
  ring: 'rgba(11, 87, 208, 0.16)',
  wedge: 'rgba(184, 80, 10, 0.28)',
  home: '#5f3dc4',
  stay_in: '#7a5c00',
  keep_out: 'rgba(179, 38, 30, 0.18)',
  run_a: '#b8500a',
  run_b: '#0b57d0',
  run_plan: 'rgba(70, 66, 52, 0.45)',
  shades: ['#2b9d8f', '#6aa84f', '#c9a400', '#e07b00', '#cf3a1d', '#7a0f3c'],
};

const dark: Palette = {
  ground: '#14171c',
  casing: 'rgba(13, 15, 19, 0.9)',
  grid_major: 'rgba(214, 222, 235, 0.22)',
  grid_minor: 'rgba(214, 222, 235, 0.08)',
  grid_label: '#aab3c2',
  plan: '#7cacff',
  selected: '#ffb066',
  refused: '#ff8a80',
  on_point: '#0d0f13',
  route: '#6dd58c',
  route_done: 'rgba(109, 213, 140, 0.35)',
  corridor: 'rgba(109, 213, 140, 0.16)',
  way: '#f0fff3',
  sign: '#e6fbea',
  current: '#ffb066',
  trail: '#ff8fd0',
  trail_classes: TRAIL_DARK,
  fixes: '#e0c14a',
  robot: '#ffffff',
  robot_stale: '#7d838d',
  ring: 'rgba(124, 172, 255, 0.20)',
  wedge: 'rgba(255, 176, 102, 0.32)',
  home: '#b9a5ff',
  stay_in: '#e0c14a',
  keep_out: 'rgba(255, 138, 128, 0.2)',
  run_a: '#ffb066',
  run_b: '#7cacff',
  run_plan: 'rgba(214, 222, 235, 0.45)',
  shades: ['#4fd1c0', '#9be27a', '#ffe26a', '#ffae42', '#ff6e52', '#ff5fb0'],
};

/** The colours of the day, deeper, and a grid that the sun does not wash away. */
const sunlight: Palette = {
  ...light,
  ground: '#ffffff',
  casing: '#ffffff',
  grid_major: 'rgba(0, 0, 0, 0.55)',
  grid_minor: 'rgba(0, 0, 0, 0.2)',
  grid_label: '#000000',
  plan: '#00309c',
  selected: '#8a3600',
  refused: '#900000',
  route: '#004a18',
  route_done: 'rgba(0, 74, 24, 0.5)',
  corridor: 'rgba(0, 120, 50, 0.22)',
  way: '#000000',
  sign: '#0a0a0a',
  current: '#d05000',
  trail: '#a00066',
  trail_classes: TRAIL_SUNLIGHT,
  fixes: '#5a4600',
  robot: '#000000',
  robot_stale: '#5c5c5c',
  home: '#3a16a0',
  stay_in: '#503c00',
  keep_out: 'rgba(144, 0, 0, 0.3)',
  run_a: '#8a3600',
  run_b: '#00309c',
  run_plan: 'rgba(0, 0, 0, 0.6)',
  shades: ['#00695c', '#3b7a00', '#8a6d00', '#b34f00', '#b00000', '#5a0030'],
};

const dark_wanted = matchMedia('(prefers-color-scheme: dark)');

const in_sunlight = (): boolean => document.documentElement.dataset['look'] === 'sunlight';

export const is_dark = (): boolean => dark_wanted.matches && !in_sunlight();

export const palette = (): Palette => (in_sunlight() ? sunlight : is_dark() ? dark : light);

/** The legend has them from the page's root: its colours are those of the map. */
export const style_legend = (): void => {
  palette().trail_classes.forEach((color, k) =>
    document.documentElement.style.setProperty(`--trail-${k}`, color),
  );
};

/** Other colours, or other words. */
export const on_palette_change = (redraw: () => void): void => {
  dark_wanted.addEventListener('change', redraw);
  new MutationObserver(redraw).observe(document.documentElement, {
    attributeFilter: ['data-look', 'lang'],
  });
};
