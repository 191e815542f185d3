// What a phone's own keyboard covers of the page.

/** The part of the page that can be seen, CSS pixels. */
export interface Seen {
  readonly height: number;
  /** Of its top from the page's. */
  readonly offsetTop: number;
  /** By two fingers; 1: none. */
  readonly scale: number;
}

/** Enlarged by more than this, a smaller part is seen because somebody wanted that. */
const ENLARGED = 1.05;

/** @param height of the page @return pixels from the bottom that a keyboard covers */
export const covered_px = (height: number, seen: Seen | null): number =>
  seen === null || seen.scale > ENLARGED
    ? 0
    : Math.max(0, Math.round(height - seen.height - seen.offsetTop));
