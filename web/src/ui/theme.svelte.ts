// Which colours the page has now: what draws with them on a canvas reads this, and so draws anew when the device
// turns dark in the evening or its holder chooses another look.

import { device } from './device.svelte';

class Theme {
  #dark = $state(false);

  constructor() {
    const wanted = matchMedia('(prefers-color-scheme: dark)');
    this.#dark = wanted.matches;
    wanted.addEventListener('change', () => (this.#dark = wanted.matches));
  }

  get now(): string {
    return `${device.settings.look} ${this.#dark ? 'dark' : 'light'}`;
  }
}

export const theme = new Theme();
