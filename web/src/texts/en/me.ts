// The phone's place: come to me, and my place as a point.

export const me = {
  come_to_me: 'Come to me',
  me_come: 'Come here',
  me_coming: 'Comes to you',
  me_close: 'Do not come to me',
  me_place: 'My place',
  me_fix: 'Your phone knows its place within {accuracy}, {age} s ago.',
  me_keeps:
    'It stops {distance} before that place: as far as your phone may be off, and the distance that it keeps.',
  me_ended: 'It does not come any more: {why}',
  me_insecure:
    'a phone tells its place only to a page over HTTPS: start roverd with --lan or --tls',
  me_missing: 'this browser does not tell where it is',
  me_denied: 'this page may not know where the phone is: allow it in the browser’s settings',
  me_unavailable: 'the phone does not find its place now',
  me_waiting: 'the phone has not found its place yet',
  me_old: 'the phone has not told its place for {age} s',
  me_vague: 'the phone knows its place only within {accuracy}; it must be {most} or better',
  me_hidden: 'the page was put away',
  me_closed: 'it was closed',
  me_add: 'Add my place',
  me_added: 'Added where your phone is, within {accuracy}.',
  me_not_added: 'Nothing was added: {why}',
} as const;
