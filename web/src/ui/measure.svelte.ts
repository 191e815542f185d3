// A line drawn to measure: no mission, and gone with the page.

import { measured } from '../model/measure';
import { Outline } from './drawing.svelte';

export class Measurer extends Outline {
  /** The person measures instead of planning. */
  open = $state(false);
  result = $derived(measured(this.places));

  constructor() {
    super('line');
  }
}
