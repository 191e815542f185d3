// The phone's place: come to me, and my place as a point.

export const me = {
  come_to_me: 'Tule luokseni',
  me_come: 'Tule tänne',
  me_coming: 'Tulee luoksesi',
  me_close: 'Älä tule luokseni',
  me_place: 'Paikkani',
  me_fix: 'Puhelimesi tietää paikkansa {accuracy} tarkkuudella, {age} s sitten.',
  me_keeps:
    'Se pysähtyy {distance} ennen sitä paikkaa: puhelimen mahdollinen virhe ja väli, jonka se pitää.',
  me_ended: 'Se ei tule enää: {why}',
  me_insecure:
    'puhelin kertoo paikkansa vain HTTPS-sivulle: käynnistä roverd valitsimella --lan tai --tls',
  me_missing: 'tämä selain ei kerro, missä se on',
  me_denied: 'tämä sivu ei saa tietää, missä puhelin on: salli se selaimen asetuksissa',
  me_unavailable: 'puhelin ei löydä paikkaansa nyt',
  me_waiting: 'puhelin ei ole vielä löytänyt paikkaansa',
  me_old: 'puhelin ei ole kertonut paikkaansa {age} sekuntiin',
  me_vague: 'puhelin tietää paikkansa vain {accuracy} tarkkuudella; tarvitaan {most} tai parempi',
  me_hidden: 'sivu laitettiin pois',
  me_closed: 'se suljettiin',
  me_add: 'Lisää paikkani',
  me_added: 'Lisätty puhelimesi paikka, tarkkuus {accuracy}.',
  me_not_added: 'Mitään ei lisätty: {why}',
} as const;
