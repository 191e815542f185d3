// The phone's place: come to me, and my place as a point.

export const me = {
  come_to_me: 'Kom til meg',
  me_come: 'Kom hit',
  me_coming: 'Kommer til deg',
  me_close: 'Ikke kom til meg',
  me_place: 'Stedet mitt',
  me_fix: 'Telefonen din vet hvor den er innenfor {accuracy}, for {age} s siden.',
  me_keeps:
    'Den stopper {distance} før det stedet: så mye telefonen kan ta feil, og avstanden den holder.',
  me_ended: 'Den kommer ikke lenger: {why}',
  me_insecure:
    'en telefon sier hvor den er bare til en side over HTTPS: start roverd med --lan eller --tls',
  me_missing: 'denne nettleseren sier ikke hvor den er',
  me_denied: 'denne siden får ikke vite hvor telefonen er: tillat det i nettleserens innstillinger',
  me_unavailable: 'telefonen finner ikke stedet sitt nå',
  me_waiting: 'telefonen har ikke funnet stedet sitt ennå',
  me_old: 'telefonen har ikke sagt hvor den er på {age} s',
  me_vague: 'telefonen vet hvor den er bare innenfor {accuracy}; det må være {most} eller bedre',
  me_hidden: 'siden ble lagt bort',
  me_closed: 'det ble lukket',
  me_add: 'Legg til stedet mitt',
  me_added: 'Lagt til der telefonen er, innenfor {accuracy}.',
  me_not_added: 'Ingenting ble lagt til: {why}',
} as const;
