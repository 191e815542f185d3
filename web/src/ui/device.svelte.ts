// How this device shows things, for all panels: the one who holds it has chosen it. The map and the
// styles read the look from the page's root.

import type { DraftStorage } from '../model/ports';
import type { Language } from '../model/say';
import { DEFAULTS, language_in, settings_of, type Settings } from '../model/settings';
import { tongue } from './language.svelte';

class Device {
  settings = $state.raw<Settings>(DEFAULTS);
  #storage: DraftStorage | null = null;

  /** @param storage where it is kept */
  open(storage: DraftStorage): void {
    this.#storage = storage;
    this.#use(settings_of(storage.read()));
  }

  choose(change: Partial<Settings>): void {
    this.#use({ ...this.settings, ...change });
    this.#storage?.write(JSON.stringify(this.settings));
  }

  get language(): Language {
    return language_in(this.settings, navigator.languages);
  }

  #use(settings: Settings): void {
    this.settings = settings;
    document.documentElement.dataset['look'] = settings.look;
    void tongue.use(this.language);
  }
}

export const device = new Device();
