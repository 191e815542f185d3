// What became of a file, row by row, and where that lies: while its dialog is open the map shows it.

import { places_in_file, NO_PLACES } from '../model/file_places';
import { import_on_map, located } from '../model/import_map';
import { line_of } from '../model/beside';
import type { LineOnMap } from '../model/on_map';
import { spots, type LatLon, type Plan } from '../model/plan';
import type { ImportEntry, ImportResult } from '../model/ports';
import { field_rings } from '../model/survey';

type Outcome = ImportEntry['outcome'];

export class ImportReport {
  readonly file: string;
  readonly result: ImportResult;
  /** Which rows are listed: first those that a person should know of. */
  listed = $state.raw<ReadonlySet<Outcome>>(new Set<Outcome>(['changed', 'left_out']));
  /** The row whose place is looked at; null: none. */
  looked = $state<number | null>(null);
  /** Further missions of the file, as far as they have come, by their numbers from 1. */
  #plans = $state.raw<ReadonlyMap<number, Plan>>(new Map());
  readonly #text: string | null;

  rows = $derived.by(() =>
    located(
      this.result.report,
      (mission) => this.#plans.get(mission),
      this.#text === null ? NO_PLACES : places_in_file(this.#text, this.result.format),
    ),
  );
  list = $derived(
    this.rows
      .map((row, k) => ({ ...row, k }))
      .filter(({ entry }) => this.listed.has(entry.outcome)),
  );
  on_map = $derived.by((): readonly LineOnMap[] => [
    ...[...this.#plans].flatMap(([mission, plan]) => (mission === 1 ? [] : line_of(plan, 'taken'))),
    ...this.result.areas.flatMap((area) =>
      field_rings(area).map((ring): LineOnMap => ({
        places: [...ring, ...ring.slice(0, 1)],
        tone: 'taken',
      })),
    ),
    ...import_on_map(this.rows, this.looked === null ? null : (this.rows[this.looked] ?? null)),
  ]);
  /** All that it tells of. */
  places = $derived.by((): readonly LatLon[] => [
    ...[...this.#plans.values()].flatMap((plan) => spots(plan)),
    ...this.result.areas.flatMap((area) => field_rings(area).flat()),
    ...this.rows.flatMap(({ places }) => places),
  ]);

  /** @param text of the file; null: too large to be read once more */
  constructor(file: string, result: ImportResult, text: string | null) {
    this.file = file;
    this.result = result;
    this.#text = text;
    if (result.mission) this.take_plan(1, result.mission);
  }

  /** @param mission its number in the file, from 1 */
  take_plan(mission: number, plan: Plan): void {
    this.#plans = new Map([...this.#plans, [mission, plan]]);
  }

  toggle(outcome: Outcome): void {
    const listed = new Set(this.listed);
    if (!listed.delete(outcome)) listed.add(outcome);
    this.listed = listed;
  }

  /** Of several missions the first is in the editor. */
  in_editor({ item, mission }: ImportEntry): boolean {
    return item !== null && (mission ?? 1) === 1 && this.result.mission !== null;
  }
}
