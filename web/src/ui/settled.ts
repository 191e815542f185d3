import { tick } from 'svelte';

/** The panel has its new height, and the map knows it. */
export const settled = async (): Promise<void> => {
  await tick();
  const frame = (): Promise<number> => new Promise(requestAnimationFrame);
  await frame();
  await frame();
};
