// The language of the page. Its texts come when it is chosen; until they are here, and where they do not
// come, the page goes on in English: nobody waits for words before the stop button is there. Some of the
// robot's sentences come behind them, once the page is live; until then those are in English, too.

import {
  IN_ENGLISH,
  say,
  speak,
  type Language,
  type LateTexts,
  type Spoken,
  type Texts,
} from '../model/say';

type Fetched = Exclude<Language, 'en'>;
const files: Readonly<Record<Fetched, () => Promise<Partial<Texts>>>> = {
  fi: async () => (await import('../texts/fi')).finnish,
  et: async () => (await import('../texts/et')).estonian,
  it: async () => (await import('../texts/it')).italian,
  nb: async () => (await import('../texts/nb')).norwegian,
};
const late_files: Readonly<Record<Language, () => Promise<{ readonly late: LateTexts }>>> = {
  en: () => import('../texts/en/late'),
  fi: () => import('../texts/fi/late'),
  et: () => import('../texts/et/late'),
  it: () => import('../texts/it/late'),
  nb: () => import('../texts/nb/late'),
};
const AGAIN_MS = 2000;

type Late = readonly [english: LateTexts, texts: LateTexts];
const late_of = async (language: Fetched): Promise<Late> => {
  const [told, here] = await Promise.all([late_files.en(), late_files[language]()]);
  return [told.late, here.late];
};
const with_late = (spoken: Spoken, [late, texts]: Late): Spoken => ({
  ...spoken,
  texts: { ...spoken.texts, ...texts },
  late,
});

class Tongue {
  spoken = $state.raw<Spoken>(IN_ENGLISH);
  #wanted: Language = 'en';
  #live = false;
  #again: ReturnType<typeof setTimeout> | undefined;

  constructor() {
    speak(() => this.spoken);
  }

  async use(language: Language): Promise<void> {
    if (language === this.#wanted) return;
    this.#wanted = language;
    try {
      const spoken = language === 'en' ? IN_ENGLISH : await this.#fetch(language);
      // Another one may have been chosen meanwhile.
      if (language === this.#wanted) this.#take(spoken);
    } catch {
      if (language === this.#wanted) this.#wanted = this.spoken.language; // may be tried again
    }
  }

  /** What can wait for it comes now, and from now on with every language. */
  page_is_live(): void {
    this.#live = true;
    void this.#bring_late();
  }

  /** On a live page all of it at once: a refusal that is told just then stays as it was said. */
  async #fetch(language: Fetched): Promise<Spoken> {
    const late = this.#live ? late_of(language).catch(() => null) : null;
    const spoken = { language, texts: await files[language]() };
    const come = await late;
    return come ? with_late(spoken, come) : spoken;
  }

  /** What does not come is asked for again. */
  async #bring_late(): Promise<void> {
    const { language, late } = this.spoken;
    if (!this.#live || language === 'en' || late) return;
    try {
      const come = await late_of(language);
      if (language === this.spoken.language) this.spoken = with_late(this.spoken, come);
    } catch {
      clearTimeout(this.#again);
      this.#again = setTimeout(() => void this.#bring_late(), AGAIN_MS);
    }
  }

  #take(spoken: Spoken): void {
    this.spoken = spoken;
    void this.#bring_late();
    document.documentElement.lang = spoken.language;
    // What the document itself says: it was there before any language was known.
    document.getElementById('map')?.setAttribute('aria-label', say('map'));
    document
      .querySelector('meta[name=description]')
      ?.setAttribute('content', say('ground_control'));
  }
}

export const tongue = new Tongue();
