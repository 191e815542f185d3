// The guide through a calibration drive.

export const guide = {
  purpose_drive:
    'Con quanto ritardo e quanta forza gira, parte e frena. Noto con precisione, si ferma dove deve e non taglia le curve. Utile dopo cingoli o gomme nuove, con un altro carico, o se oscilla oltre il percorso.',
  purpose_steering:
    'Come stanno le ruote quando va dritto, e con quanto ritardo sterzano. Utile se viaggia accanto alla linea, sempre dallo stesso lato.',
  purpose_compass:
    'Di quanto sbaglia la bussola in questo luogo. Solo per informazione: altrove il metallo vicino la cambia.',
  purpose_antennas:
    'Di quanto sono montate storte le due antenne. Utile se va dritto ma la freccia sulla mappa punta di lato.',
  figure_drive:
    'Percorre sei rettilinei di 6 m, avanti e indietro, girando sul posto; un’auto fa un giro per ogni lato.',
  figure_steering: 'Fa un giro per ogni lato, con rettilinei di 10 m.',
  figure_compass: 'Gira lentamente una volta per lato; un’auto percorre un cerchio.',
  figure_antennas: 'Percorre quattro rettilinei, avanti e indietro.',
  stage_prepare: 'Prepara',
  stage_drive: 'Guida',
  stage_judge: 'Valuta',
  stages: 'Fasi della calibrazione',
  guide_what_for: 'A che serve',
  guide_what_happens: 'Che cosa succede',
  guide_before: 'Prima di iniziare',
  guide_ground:
    'Terreno piano e solido, senza persone né ostacoli: l’area tracciata sulla mappa. Se il bordo è rosso non può iniziare: sposta o gira il robot.',
  guide_stay: 'Resta dove lo vedi per intero, con un dito su STOP.',
  guide_watch:
    'Bada che nessuno entri nell’area tracciata. HOLD o STOP la terminano subito; allora nulla cambia.',
  guide_judge:
    'Confronta prima e dopo. Se è difficile da credere, scarta e misura ancora; due prove concordi sono affidabili.',
  guide_keep:
    'Tieni: agisce subito e per 90 giorni, anche dopo un riavvio. Scarta: guida come prima.',
  guide_nothing_kept: 'Il robot non ne usa nulla: leggi e chiudi.',
  guide_what_now: 'Che fare',
  guide_figures: 'Che cosa indicano i valori',
  ready_ground: 'Terreno',
  ready_fits: 'ci sta, come sulla mappa',
  ready_does_not_fit: 'qui non ci sta',
  ready_at_most: '{now}, al massimo {most}',
  fail_position: 'Attendi RTK fisso, o vai dove l’antenna vede il cielo, e ricomincia.',
  fail_contradict:
    'Alcuni sensori si contraddicono: guida a mano qualche metro finché i controlli sono a posto e ricomincia.',
  fail_heading: 'Guida a mano qualche metro dritto e ricomincia.',
  fail_fence: 'Sposta o gira il robot così che l’area tracciata stia nel recinto.',
  fail_slowed:
    'Qualcosa ha limitato la velocità: libera il terreno, guarda gli avvisi sopra la mappa e ricomincia.',
  fail_space: 'È scivolato fuori dall’area: scegli un terreno più solido e più spazio.',
  fail_slope: 'Il terreno è troppo inclinato: scegline uno piano.',
  fail_obeys:
    'Non esegue in tempo: controlla batteria, freni e cingoli, togli carico e ricomincia.',
  fail_other: 'Chiudi, rimedia alla causa e ricomincia. Quanto misurato finora non si usa.',
  mean_turn_delay: 'dal comando di girare a quando gira',
  mean_drive_delay: 'dal comando di guida a quando parte',
  mean_braking: 'quanto rallenta ogni secondo; di più è un arresto più corto',
  mean_acceleration: 'quanto accelera ogni secondo',
  mean_speed_scale: 'metri percorsi per ogni metro indicato dalle ruote; 1 è esatto',
  mean_turn_scale: 'gradi girati per ogni grado comandato; 1 è esatto',
  mean_side_bias: 'quanto curva quando va dritto; 0 è dritto',
  mean_steering_zero: 'come stanno le ruote quando va dritto',
  mean_compass_offset: 'quanto segna in più la bussola',
  mean_compass_spread: 'quanto resta dell’errore, secondo la rotta; piccolo è bene',
  mean_antennas_offset: 'di quanto le antenne puntano a lato del dritto',
} as const;
