import { expect, it } from 'vitest';

import { accuracy_mark, inexact_words, ortho_words } from '../src/ortho/words';

it('says how well a picture lies, and for good', () => {
  const datum = { name: 'OSGB36', good_to_m: 5 };
  expect(inexact_words('Farm', datum)).toContain('to about 5 m only');
  expect(inexact_words('Farm', datum)).toContain('(OSGB36)');
  expect(accuracy_mark(datum)).toBe('± 5 m (OSGB36)');
  const own = { name: 'TOWGS84', good_to_m: null };
  expect(inexact_words('Farm', own)).toContain('a shift of its own');
  expect(accuracy_mark(own)).toBe('± ? m (TOWGS84)');
});

it('says why a picture is not taken, and what to do', () => {
  expect(ortho_words('no_datum', 'NAD27')).toContain('its coordinate system (NAD27)');
  expect(ortho_words('no_datum', 'NAD27')).toContain('gdalwarp -t_srs EPSG:4326');
  expect(ortho_words('other_axes', '')).toContain('gdalwarp -t_srs EPSG:4326');
  expect(ortho_words('not_8_bit', '16')).toBe('its colours do not have 8 bits each (16)');
});
