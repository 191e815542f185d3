// The phone's own place, from the browser; and the call that tells the robot of it. A browser tells it
// only to a page that can be trusted: over HTTPS, or from this computer.

import type { Fix, MeCalls, NoPlace } from '../model/me';
import { request } from './request';
import type { Seen } from './rest';
import type { components } from './schema';

type Schemas = components['schemas'];

/** What comes later is told anew anyhow. */
const TELL_LIMIT_MS = 1500;
const FIX_LIMIT_MS = 10_000;

const impossible = (): NoPlace | null => {
  if (!window.isSecureContext) return 'insecure';
  return 'geolocation' in navigator ? null : 'missing';
};

const fix_of = ({ coords, timestamp }: GeolocationPosition): Fix => ({
  lat: coords.latitude,
  lon: coords.longitude,
  accuracy_m: coords.accuracy,
  // Stamped by a clock that may be set meanwhile.
  at_ms: performance.now() - Math.max(0, Date.now() - timestamp),
});

export const me_calls = (seen: Seen): MeCalls => ({
  impossible: impossible(),
  watch: (on_fix, on_none) => {
    const why = impossible();
    if (why !== null) {
      on_none(why);
      return () => undefined;
    }
    const id = navigator.geolocation.watchPosition(
      (position) => on_fix(fix_of(position)),
      ({ code, PERMISSION_DENIED }) =>
        on_none(code === PERMISSION_DENIED ? 'denied' : 'unavailable'),
      { enableHighAccuracy: true, maximumAge: 0, timeout: FIX_LIMIT_MS },
    );
    return () => navigator.geolocation.clearWatch(id);
  },
  tell: (target) => {
    const seen_s = seen();
    return request<Schemas['Vehicle']>('/vehicle/target', {
      method: 'PUT',
      body: target,
      headers: seen_s === null ? {} : { 'Roverd-Seen': seen_s.toFixed(3) },
      limit_ms: TELL_LIMIT_MS,
    });
  },
  gap_m: async () => {
    const answer = await request<Schemas['Parameter']>('/parameters/nav.modes.follow_gap_m');
    return answer.ok && typeof answer.value.value === 'number' ? answer.value.value : null;
  },
  on_hidden: (hidden) => {
    const look = (): void => {
      if (document.visibilityState === 'hidden') hidden();
    };
    document.addEventListener('visibilitychange', look);
    return () => document.removeEventListener('visibilitychange', look);
  },
  now_ms: () => performance.now(),
});
