import type { SiteMap } from '../src/model/site_map';

/** Ten metres by six, its origin in a corner; it lies nowhere, and is not in use. */
export const SHED: SiteMap = {
  id: 3,
  name: 'shed',
  revision: 1,
  created_at: '2026-05-01T10:00:00Z',
  width: 100,
  height: 60,
  resolution_m: 0.1,
  origin: { x_m: 0, y_m: 0, yaw_deg: 0 },
  anchor: null,
  placed: null,
  in_use: false,
  solid: false,
  size_bytes: 6000,
  problem: null,
};
