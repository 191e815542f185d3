// The guide through a calibration drive.

export const guide = {
  purpose_drive:
    'Kui hilja ja kui tugevalt see pöörab, kohalt võtab ja pidurdab. Kui see on täpselt teada, peatub ta õiges kohas ega lõika nurki. Tee seda uute roomikute või rehvide järel, teise koormaga või kui ta teest üle vingerdab.',
  purpose_steering:
    'Kuidas rattad on, kui kästakse otse, ja kui hilja need pöörduvad. Tee seda, kui ta sõidab joone kõrval alati samal pool.',
  purpose_compass:
    'Kui palju kompass siin kohas eksib. Ainult teadmiseks: lähedal olev metall muudab seda mujal.',
  purpose_antennas:
    'Kui viltu kaks antenni on. Tee seda, kui ta sõidab otse, aga nool kaardil osutab kõrvale.',
  figure_drive:
    'See sõidab kuus 6 m sirget edasi-tagasi ja pöörab kohapeal; auto teeb ringi kummalegi poole.',
  figure_steering: 'See sõidab ringi kummalegi poole, 10 m sirgetega.',
  figure_compass: 'See pöörab aeglaselt korra kummalegi poole; auto sõidab ringi.',
  figure_antennas: 'See sõidab neli sirget edasi-tagasi.',
  stage_prepare: 'Valmista ette',
  stage_drive: 'Sõida',
  stage_judge: 'Hinda',
  stages: 'Kalibreerimise sammud',
  guide_what_for: 'Milleks see on',
  guide_what_happens: 'Mis juhtub',
  guide_before: 'Enne alustamist',
  guide_ground:
    'Tasane kindel pind, kus pole kedagi ega midagi ees: piiritletud ala kaardil. Kui piir on punane, ei saa alustada: liiguta või pööra robotit.',
  guide_stay: 'Püsi kohas, kust näed kogu ala, sõrm STOP-nupul.',
  guide_watch:
    'Jälgi, et keegi piiritletud alale ei astuks. HOLD või STOP lõpetab kohe; siis ei muutu midagi.',
  guide_judge:
    'Võrdle enne ja pärast. Kui tulemust on raske uskuda, viska see ära ja mõõda uuesti; kaht ühesugust tulemust võib uskuda.',
  guide_keep: 'Jäta: mõjub kohe ja 90 päeva, ka pärast taaskäivitust. Viska ära: sõidab nagu enne.',
  guide_nothing_kept: 'Robot ei kasuta sellest midagi: loe ja sulge.',
  guide_what_now: 'Mida teha',
  guide_figures: 'Mida arvud tähendavad',
  ready_ground: 'Ala',
  ready_fits: 'mahub, nagu kaardil',
  ready_does_not_fit: 'ei mahu siia',
  ready_at_most: '{now}, kõige rohkem {most}',
  fail_position: 'Oota RTK-lahendit või mine lageda taeva alla ja alusta uuesti.',
  fail_contradict:
    'Andurid räägivad üksteisele vastu: sõida käsitsi mõni meeter, kuni kontrollid on korras, ja alusta uuesti.',
  fail_heading: 'Sõida käsitsi mõni meeter otse ja alusta uuesti.',
  fail_fence: 'Sõida või pööra robotit nii, et piiritletud ala jääb tara sisse.',
  fail_slowed:
    'Miski piiras kiirust: tühjenda ala, vaata, mis kaardi kohal kirjas on, ja alusta uuesti.',
  fail_space: 'See libises alalt välja: vali kindlam pind ja rohkem ruumi.',
  fail_slope: 'Pind on liiga kaldu: vali tasane koht.',
  fail_obeys:
    'See ei kuuletu õigel ajal: vaata akut, pidureid ja roomikuid, vähenda koormat ja alusta uuesti.',
  fail_other: 'Sulge, kõrvalda põhjus ja alusta uuesti. Seni mõõdetut ei kasutata.',
  mean_turn_delay: 'pöördekäsust pöördumiseni',
  mean_drive_delay: 'sõidukäsust liikumiseni',
  mean_braking: 'kui palju aeglustub sekundis; rohkem tähendab lühemat peatumist',
  mean_acceleration: 'kui palju kiireneb sekundis',
  mean_speed_scale: 'sõidetud meetrid ratta öeldud meetri kohta; 1 on täpne',
  mean_turn_scale: 'pööratud kraadid kästud kraadi kohta; 1 on täpne',
  mean_side_bias: 'kuidas kaardub, kui kästakse otse; 0 on otse',
  mean_steering_zero: 'rataste asend, kui kästakse otse',
  mean_compass_offset: 'kui palju kompass liiga näitab',
  mean_compass_spread: 'mis veast jääb, suuna järgi; väike on hea',
  mean_antennas_offset: 'kui palju antennid otsesihist kõrvale osutavad',
} as const;
