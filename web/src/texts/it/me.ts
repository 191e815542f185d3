// The phone's place: come to me, and my place as a point.

export const me = {
  come_to_me: 'Vieni da me',
  me_come: 'Vieni qui',
  me_coming: 'Viene da te',
  me_close: 'Non venire da me',
  me_place: 'La mia posizione',
  me_fix: 'Il tuo telefono conosce la sua posizione entro {accuracy}, {age} s fa.',
  me_keeps:
    'Si ferma {distance} prima di quel punto: l’errore possibile del telefono e la distanza che mantiene.',
  me_ended: 'Non viene più: {why}',
  me_insecure:
    'un telefono dice la sua posizione solo a una pagina HTTPS: avvia roverd con --lan o --tls',
  me_missing: 'questo browser non dice dove si trova',
  me_denied:
    'questa pagina non può sapere dove è il telefono: consentilo nelle impostazioni del browser',
  me_unavailable: 'il telefono ora non trova la sua posizione',
  me_waiting: 'il telefono non ha ancora trovato la sua posizione',
  me_old: 'il telefono non dice la sua posizione da {age} s',
  me_vague: 'il telefono conosce la sua posizione solo entro {accuracy}; serve {most} o meglio',
  me_hidden: 'la pagina è stata messa via',
  me_closed: 'è stato chiuso',
  me_add: 'Aggiungi la mia posizione',
  me_added: 'Aggiunto dove è il telefono, entro {accuracy}.',
  me_not_added: 'Niente è stato aggiunto: {why}',
} as const;
