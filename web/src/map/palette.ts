// Colours of what is drawn on the canvas. Everything has a casing in the ground's colour, so that it
// stays readable on tiles and in bright sun.

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
  /** Within the route. */
  readonly way: string;
  readonly current: string;
  readonly trail: string;
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
  way: '#06260f',
  current: '#e8710a',
  trail: '#a8327a',
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
  way: '#f0fff3',
  current: '#ffb066',
  trail: '#ff8fd0',
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
  way: '#000000',
  current: '#d05000',
  trail: '#a00066',
  fixes: '#5a4600',
  robot: '#000000',
  robot_stale: '#5c5c5c',
  home: '#3a16a0',
  stay_in: '#503c00',
  keep_out: 'rgba(144, 0, 0, 0.3)',
  run_a: '#8a3600',
  run_b: '#00309c',
  run_plan: 'rgba(0, 0, 0, 0.6)',
};

const dark_wanted = matchMedia('(prefers-color-scheme: dark)');

const in_sunlight = (): boolean => document.documentElement.dataset['look'] === 'sunlight';

export const is_dark = (): boolean => dark_wanted.matches && !in_sunlight();

export const palette = (): Palette => (in_sunlight() ? sunlight : is_dark() ? dark : light);

export const on_palette_change = (redraw: () => void): void => {
  dark_wanted.addEventListener('change', redraw);
  new MutationObserver(redraw).observe(document.documentElement, {
    attributeFilter: ['data-look'],
  });
};
