// The language of the page. Its texts come when it is chosen; until they are here, and where they do not
// come, the page goes on in English: nobody waits for words before the stop button is there.

import { IN_ENGLISH, say, speak, type Language, type Spoken, type Texts } from '../model/say';

const files: Readonly<Record<Exclude<Language, 'en'>, () => Promise<Partial<Texts>>>> = {
  fi: async () => (await import('../texts/fi')).finnish,
  et: async () => (await import('../texts/et')).estonian,
  it: async () => (await import('../texts/it')).italian,
  nb: async () => (await import('../texts/nb')).norwegian,
};

class Tongue {
  spoken = $state.raw<Spoken>(IN_ENGLISH);
  #wanted: Language = 'en';

  constructor() {
    speak(() => this.spoken);
  }

  async use(language: Language): Promise<void> {
    if (language === this.#wanted) return;
    this.#wanted = language;
    try {
      const texts = language === 'en' ? IN_ENGLISH.texts : await files[language]();
      // Another one may have been chosen meanwhile.
      if (language === this.#wanted) this.#take({ language, texts });
    } catch {
      if (language === this.#wanted) this.#wanted = this.spoken.language; // may be tried again
    }
  }

  #take(spoken: Spoken): void {
    this.spoken = spoken;
    document.documentElement.lang = spoken.language;
    // What the document itself says: it was there before any language was known.
    document.getElementById('map')?.setAttribute('aria-label', say('map'));
    document
      .querySelector('meta[name=description]')
      ?.setAttribute('content', say('ground_control'));
  }
}

export const tongue = new Tongue();
