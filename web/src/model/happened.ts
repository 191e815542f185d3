// What happened on the robot: which of it deserves a message, and what is one and the same.

import type { StationEvent } from './vehicle';

/** Tells events apart: the stream sends them before they have a number. */
export const event_key = ({ time, kind, detail }: StationEvent): string =>
  `${time} ${kind} ${detail}`;

/** Good news that a person waits for. The other good news is only logged. */
const TOLD = new Set(['mission_finished', 'mission_lap', 'radio_takeover', 'radio_released']);
/** What the page itself shows already, in the answer to its command. */
const SHOWN_ELSEWHERE = new Set(['arm_refused', 'estop', 'disarmed']);

/** Whether an event deserves a message on the screen, besides its line in the log. */
export const worth_a_word = ({ level, kind }: StationEvent): boolean =>
  level === 'info' ? TOLD.has(kind) : !SHOWN_ELSEWHERE.has(kind);

const ENDS_DRIVING = new Set([
  'estop',
  'disarmed',
  'stopped',
  'mission_paused',
  'mission_aborted',
  'blocked',
  'activity_held',
  'base_left_control',
]);

/** After it the robot does not do any more what it was told before. */
export const ended_driving = ({ kind, detail }: StationEvent): boolean =>
  kind === 'mode' ? detail.startsWith('mode HOLD') : ENDS_DRIVING.has(kind);

/** Numbers of items and values that were changed say which; a measure that differs says nothing new. */
const EACH_ITS_OWN = /^(?:item_|action|parameter|safety_parameter)/;
const MEASURE = /\d+(?:\.\d+)?(?=\s?(?:m|cm|km|s|ms|min|deg|V|m\/s)\b|\s?[%°])/g;

/** The same for all that differ in nothing but what was measured. */
export const event_shape = ({ level, kind, detail }: StationEvent): string =>
  `${level} ${kind} ${EACH_ITS_OWN.test(kind) ? detail : detail.replaceAll(MEASURE, '#')}`;

/** What one message is kept of, the newest: a driver that comes and goes, the same with other figures. */
export const event_about = (event: StationEvent): string =>
  event.kind.startsWith('driver_')
    ? `driver ${/^[^\s:]*/.exec(event.detail)?.[0] ?? ''}`
    : event_shape(event);
