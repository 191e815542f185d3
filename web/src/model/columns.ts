// Signals for the chart as columns, one per signal, in a bounded window of the latest samples. A
// value that is unknown is null and leaves a gap in the line.

export type Columns = [t_s: number[], ...signals: (number | null)[][]];

/** @param capacity samples kept */
export const empty_columns = (signals: number): Columns => [
  [],
  ...Array.from({ length: signals }, () => []),
];

/** Adds one sample in place and drops the oldest above `capacity`; time must grow. */
export const add_sample = (
  columns: Columns,
  capacity: number,
  t_s: number,
  values: readonly (number | null)[],
): boolean => {
  const [times, ...signals] = columns;
  const last = times.at(-1);
  if (last !== undefined && t_s <= last) return false;
  times.push(t_s);
  signals.forEach((column, k) => column.push(values[k] ?? null));
  while (times.length > capacity) columns.forEach((column) => column.shift());
  return true;
};
