// What the page can wait for: all but the state of the robot, its warnings, and the stop button.

export { default as Above } from './Above.svelte';
export { default as OverMap } from './OverMap.svelte';
export { default as Panel } from './Panel.svelte';
