// Sounds of the page's own: a stop before something, the way free again, and blocked for good. Browsers
// let a page sound only after somebody touched it: then and not before.

import type { Sound } from '../model/obstacle';

/** Hz and seconds, one note after the other. */
const notes: Readonly<Record<Sound, readonly (readonly [hz: number, s: number])[]>> = {
  stopped: [
    [660, 0.12],
    [440, 0.22],
  ],
  free: [
    [520, 0.1],
    [780, 0.14],
  ],
  blocked: [
    [440, 0.18],
    [330, 0.18],
    [440, 0.18],
    [330, 0.3],
  ],
};
const LOUD = 0.25;
const GAP_S = 0.04;

export class Speaker {
  #context: AudioContext | null = null;

  constructor() {
    const wake = (): void => {
      window.removeEventListener('pointerdown', wake);
      window.removeEventListener('keydown', wake);
      if (typeof AudioContext === 'undefined') return;
      this.#context = new AudioContext();
    };
    window.addEventListener('pointerdown', wake);
    window.addEventListener('keydown', wake);
  }

  play(sound: Sound): void {
    const context = this.#context;
    if (!context) return;
    void context.resume();
    let at = context.currentTime;
    for (const [hz, seconds] of notes[sound]) {
      const tone = context.createOscillator();
      const volume = context.createGain();
      tone.type = 'triangle';
      tone.frequency.value = hz;
      volume.gain.setValueAtTime(LOUD, at);
      volume.gain.linearRampToValueAtTime(0, at + seconds);
      tone.connect(volume).connect(context.destination);
      tone.start(at);
      tone.stop(at + seconds);
      at += seconds + GAP_S;
    }
  }
}
