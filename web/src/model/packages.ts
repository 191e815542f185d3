// What roverd is made of, as the README lists it.

export interface Package {
  readonly name: string;
  readonly version: string;
  readonly licence: string;
}

/** Rows of the tables under "Dependencies". */
export const packages_of = (readme: string): Package[] => {
  const [, section = ''] = readme.split(/^## Dependencies$/m);
  const [tables = ''] = section.split(/^## /m);
  return tables.split('\n').flatMap((line) => {
    const [name, version, licence] = line
      .split('|')
      .slice(1, -1)
      .map((cell) => cell.trim());
    const is_row = name && version && licence && !/^:?-+:?$/.test(name) && version !== 'version';
    return is_row ? [{ name, version, licence }] : [];
  });
};
