// Sounds of the page's own: a stop before something, the way free again, blocked for good, and what
// happens to the mission. Browsers let a page sound only after somebody touched it: then and not before.

import { language_said, robot_says } from '../model/robot_words';
import { language_now } from '../model/say';
import { cue_of, notes_of, vibration_of, type Cue, type CueSettings } from '../model/cues';
import { sentence } from '../model/format';
import type { Sound } from '../model/obstacle';
import type { StationEvent } from '../model/vehicle';

/** Hz and seconds, one note after the other. */
const notes: Readonly<Record<Sound | Cue, readonly (readonly [hz: number, s: number])[]>> = {
  ...notes_of,
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

  play(sound: Sound | Cue): void {
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

  /** What happened is heard, felt and read aloud, as this device is set. */
  tell(event: StationEvent, { sound, vibration, speech }: CueSettings): void {
    const cue = cue_of(event);
    if (cue === null) return;
    if (sound) this.play(cue);
    // A device without a motor, or a page that nobody has touched yet, says no.
    if (vibration && 'vibrate' in navigator) navigator.vibrate([...vibration_of[cue]]);
    if (speech && 'speechSynthesis' in window) {
      const words = new SpeechSynthesisUtterance(sentence(robot_says(event.detail)));
      words.lang = language_said(event.detail) ?? language_now();
      window.speechSynthesis.speak(words);
    }
  }
}

/** One for the whole page. */
export const speaker = new Speaker();
