// What the page keeps on the device: the draft, which layers are shown, and how it shows things. Private windows and full
// disks refuse: that is no error of the page.

import type { DraftStorage } from '../model/ports';

const storage_of = (key: string): DraftStorage => ({
  read: () => {
    try {
      return localStorage.getItem(key);
    } catch {
      return null;
    }
  },
  write: (text) => {
    try {
      localStorage.setItem(key, text);
      return true;
    } catch {
      return false;
    }
  },
});

/** Of what is edited. */
export const kept_storage = {
  draft: storage_of('roverd.draft'),
  past: storage_of('roverd.past'),
  makings: storage_of('roverd.makings'),
};
export const ground_storage = storage_of('roverd.ground');
export const layer_storage = storage_of('roverd.layers');
export const camera_storage = storage_of('roverd.camera');
export const settings_storage = storage_of('roverd.settings');
export const view_storage = storage_of('roverd.view');
