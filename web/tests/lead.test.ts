// What the mission's card says of an item by sight.

import { describe, expect, it } from 'vitest';

import { lead_words } from '../src/model/start';

describe('what leads an item by sight', () => {
  it('names what it is and who tells it', () => {
    expect(lead_words({ what: 'wall', source: 'scan', by: 'auto' })).toBe(
      'Follows the wall, seen by: scanner',
    );
    expect(lead_words({ what: 'landmarks', source: 'both', by: 'auto' })).toBe(
      'Passes landmarks, seen by: both',
    );
    expect(lead_words({ what: 'tag', source: 'vision', by: 'auto' })).toBe(
      'Comes to the tag, seen by: camera',
    );
  });
  it('says that nobody sees it', () => {
    expect(lead_words({ what: 'row', source: null, by: 'auto' })).toBe(
      'Follows the row: not seen now',
    );
  });
});
