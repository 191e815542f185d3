// Colours of the trail's classes, from little to much, and last where it is not known. Each step is seen
// without colours as well: half as bright again on dark, a third darker on light ground, and a wider
// line.

export const TRAIL_LIGHT: readonly string[] = [
  '#1e99e6',
  '#078473',
  '#7b5303',
  '#7d210a',
  '#4c0d28',
  '#77757a',
];
export const TRAIL_DARK: readonly string[] = [
  '#783ae3',
  '#1784d1',
  '#2db392',
  '#eebe2e',
  '#fcf09c',
  '#9097a3',
];
export const TRAIL_SUNLIGHT: readonly string[] = [
  '#057acd',
  '#006d5e',
  '#664400',
  '#6c0e00',
  '#3b031f',
  '#5c5c5c',
];

export const TRAIL_WIDTHS_PX: readonly number[] = [3, 4, 5, 6, 7.5, 2];
