import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';

import { packages_of } from '../src/model/packages';

describe('what roverd is made of', () => {
  it('is every row of the tables under "Dependencies", and nothing else', () => {
    const readme = [
      '# x',
      '| option | meaning | more |',
      '| `--port` | N | - |',
      '## Dependencies',
      'From Debian:',
      '| library | version | licence |',
      '|---|---|---|',
      '| Eigen | 3.4.0 | MPL-2.0 |',
      '',
      '| package | version | licence |',
      '| :-- | --- | --- |',
      '| Vite, Vitest | 8.3.8, 4.1.12 | MIT |',
      '## Tests',
      '| a | b | c |',
    ].join('\n');
    expect(packages_of(readme)).toEqual([
      { name: 'Eigen', version: '3.4.0', licence: 'MPL-2.0' },
      { name: 'Vite, Vitest', version: '8.3.8, 4.1.12', licence: 'MIT' },
    ]);
    expect(packages_of('# nothing')).toEqual([]);
  });

  it('is found in the README as it is', () => {
    const names = packages_of(readFileSync('../README.md', 'utf8')).map(({ name }) => name);
    expect(names).toContain('OpenLayers (in the page)');
    expect(names).toContain('SQLite');
    expect(names.length).toBeGreaterThan(30);
  });
});
