// The draft on the device. Private windows and full disks refuse: that is no error of the page.

import type { DraftStorage } from '../model/ports';

const KEY = 'roverd.draft';

export const draft_storage: DraftStorage = {
  read: () => {
    try {
      return localStorage.getItem(KEY);
    } catch {
      return null;
    }
  },
  write: (text) => {
    try {
      localStorage.setItem(KEY, text);
      return true;
    } catch {
      return false;
    }
  },
};
