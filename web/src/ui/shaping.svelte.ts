// A transform of the chosen items while its amounts are set: seen on the map before it is done.

import { line_of } from '../model/beside';
import type { LineOnMap } from '../model/on_map';
import type { Plan } from '../model/plan';
import { first_amounts, why_not_apply, type Transform } from '../model/transforms';
import type { Editor } from './editor.svelte';

export class Shaping {
  transform = $state.raw<Transform | null>(null);
  amounts = $state.raw<Readonly<Record<string, number>>>({});
  readonly #editor: Editor;

  /** What would come of it; null: nothing is being done. */
  readonly preview = $derived.by<Plan | null>(() => {
    const { transform, amounts } = this;
    if (!transform) return null;
    return transform.action(this.#editor.picked, amounts)(this.#editor.plan);
  });
  readonly why_not = $derived.by<string | null>(() =>
    this.preview === null ? null : why_not_apply(this.#editor.plan, this.preview),
  );
  /** As it is now. */
  readonly beside = $derived.by<readonly LineOnMap[]>(() => {
    const { plan } = this.#editor;
    return this.preview === null || this.preview === plan ? [] : line_of(plan, 'before');
  });

  constructor(editor: Editor) {
    this.#editor = editor;
    editor.previewed_by(this);
  }

  get open(): boolean {
    return this.transform !== null;
  }

  begin(transform: Transform): void {
    this.transform = transform;
    this.amounts = first_amounts(transform);
  }

  set(key: string, value: number): void {
    this.amounts = { ...this.amounts, [key]: value };
  }

  cancel(): void {
    this.transform = null;
  }

  /** One step, as undo takes it back. */
  apply(): void {
    const { preview } = this;
    this.cancel();
    if (preview === null) return;
    const same_items = preview.items.length === this.#editor.plan.items.length;
    this.#editor.do(() => preview);
    // After points came or went other ones have their numbers.
    if (!same_items) this.#editor.choose_tool('pick');
    if (!same_items) this.#editor.pick_only(new Set());
  }
}
