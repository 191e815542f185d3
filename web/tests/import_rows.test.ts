import { describe, expect, it } from 'vitest';

import { sorted_files } from '../src/model/dropped';
import { row_words } from '../src/model/import_rows';

describe('where something stands in a file', () => {
  it('is counted from one, by what the format calls it', () => {
    expect(row_words('/mission/items/2')).toBe('item 3');
    expect(row_words('/features/0/geometry/coordinates/11')).toBe('feature 1, point 12');
    expect(row_words('/geoFence/polygons/1/polygon/0')).toBe('polygon 2, point 1');
    expect(row_words('/rallyPoints/points/4')).toBe('point 5');
  });

  it('stays as it is where the file has lines, and where nothing is known of it', () => {
    expect(row_words('line 7')).toBe('line 7');
    expect(row_words('/mission')).toBe('/mission');
    expect(row_words('/features/3/crs')).toBe('feature 4, crs');
    expect(row_words('/lists/3')).toBe('lists, 4');
    expect(row_words('/')).toBe('/');
  });
});

describe('dropped files', () => {
  it('are maps by their endings, and missions otherwise', () => {
    const names = ['a.plan', 'yard.YAML', 'yard.pgm', 'b', 'hall.pcd', 'm.PNG', 'c.yml.gpx'].map(
      (name) => ({ name }),
    );
    const { missions, maps } = sorted_files(names);
    expect(missions.map(({ name }) => name)).toEqual(['a.plan', 'b', 'c.yml.gpx']);
    expect(maps.map(({ name }) => name)).toEqual(['yard.YAML', 'yard.pgm', 'hall.pcd', 'm.PNG']);
  });
});
