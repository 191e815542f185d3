// The phone's place: come to me, and my place as a point.

export const me = {
  come_to_me: 'Tule minu juurde',
  me_come: 'Tule siia',
  me_coming: 'Tuleb sinu juurde',
  me_close: 'Ära tule minu juurde',
  me_place: 'Minu koht',
  me_fix: 'Sinu telefon teab oma kohta {accuracy} täpsusega, {age} s tagasi.',
  me_keeps: 'Ta peatub {distance} enne seda kohta: telefoni võimalik viga ja vahe, mida ta hoiab.',
  me_ended: 'Ta ei tule enam: {why}',
  me_insecure: 'telefon ütleb oma koha ainult HTTPS-lehele: käivita roverd võtmega --lan või --tls',
  me_missing: 'see brauser ei ütle, kus ta on',
  me_denied: 'see leht ei tohi teada, kus telefon on: luba see brauseri seadetes',
  me_unavailable: 'telefon ei leia praegu oma kohta',
  me_waiting: 'telefon ei ole oma kohta veel leidnud',
  me_old: 'telefon ei ole oma kohta öelnud {age} s',
  me_vague: 'telefon teab oma kohta ainult {accuracy} täpsusega; vaja on {most} või paremat',
  me_hidden: 'leht pandi ära',
  me_closed: 'see suleti',
  me_add: 'Lisa minu koht',
  me_added: 'Lisatud sinu telefoni koht, täpsus {accuracy}.',
  me_not_added: 'Midagi ei lisatud: {why}',
} as const;
