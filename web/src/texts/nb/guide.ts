// The guide through a calibration drive.

export const guide = {
  purpose_drive:
    'Hvor sent og hvor hardt det svinger, starter og bremser. Når dette er kjent, stopper det der det skal og kutter ingen hjørner. Gjør det etter nye belter eller dekk, med annen last, eller når det svinger forbi veien.',
  purpose_steering:
    'Hvordan hjulene står når det skal rett fram, og hvor sent de svinger. Gjør det når det kjører ved siden av linja, alltid på samme side.',
  purpose_compass:
    'Hvor mye kompasset viser feil på dette stedet. Bare til orientering: metall i nærheten gjør det annerledes andre steder.',
  purpose_antennas:
    'Hvor skjevt de to antennene er montert. Gjør det når det kjører rett, men pila på kartet peker til siden.',
  figure_drive:
    'Det kjører seks rette strekk på 6 m fram og tilbake og snur på stedet; en bil kjører en runde til hver side.',
  figure_steering: 'Det kjører en runde til hver side, med rette strekk på 10 m.',
  figure_compass: 'Det snur sakte én gang til hver side; en bil kjører en sirkel.',
  figure_antennas: 'Det kjører fire rette strekk fram og tilbake.',
  stage_prepare: 'Forbered',
  stage_drive: 'Kjør',
  stage_judge: 'Vurder',
  stages: 'Trinn i kalibreringen',
  guide_what_for: 'Hva det er til',
  guide_what_happens: 'Hva som skjer',
  guide_before: 'Før du begynner',
  guide_ground:
    'Jevnt, fast underlag uten folk eller hindringer: det omrissede området på kartet. Er omrisset rødt, kan det ikke begynne: flytt eller snu roboten.',
  guide_stay: 'Bli der du ser alt, med en finger på STOP.',
  guide_watch:
    'Pass på at ingen går inn på området. HOLD eller STOP avslutter straks; da endres ingenting.',
  guide_judge:
    'Sammenlign før og etter. Er det vanskelig å tro, forkast og mål på nytt; to like resultater kan du stole på.',
  guide_keep: 'Behold: virker straks og i 90 dager, også etter omstart. Forkast: kjører som før.',
  guide_nothing_kept: 'Roboten bruker ingenting av dette: les og lukk.',
  guide_what_now: 'Hva du kan gjøre',
  guide_figures: 'Hva tallene betyr',
  ready_ground: 'Område',
  ready_fits: 'passer, som tegnet på kartet',
  ready_does_not_fit: 'passer ikke her',
  ready_at_most: '{now}, høyst {most}',
  fail_position: 'Vent på RTK fast, eller gå dit antennen ser åpen himmel, og begynn igjen.',
  fail_contradict:
    'Noen sensorer motsier hverandre: kjør noen meter for hånd til kontrollene er i orden, og begynn igjen.',
  fail_heading: 'Kjør noen meter rett fram for hånd, og begynn igjen.',
  fail_fence: 'Kjør eller snu roboten slik at området ligger innenfor gjerdet.',
  fail_slowed: 'Noe begrenset farten: rydd området, se hva som står over kartet, og begynn igjen.',
  fail_space: 'Det skled ut av området: velg fastere grunn med mer plass.',
  fail_slope: 'Bakken heller for mye: velg jevnt underlag.',
  fail_obeys:
    'Det lystrer ikke i tide: se på batteri, bremser og belter, ta av last, og begynn igjen.',
  fail_other:
    'Lukk, rett opp det som er grunnen, og begynn igjen. Det som er målt hittil brukes ikke.',
  mean_turn_delay: 'fra kommando til det svinger',
  mean_drive_delay: 'fra kommando til det kjører',
  mean_braking: 'hvor mye det bremser per sekund; mer gir kortere stopp',
  mean_acceleration: 'hvor mye det øker farten per sekund',
  mean_speed_scale: 'kjørte meter for hver meter hjulene sier; 1 er nøyaktig',
  mean_turn_scale: 'grader svingt for hver grad som ble bedt om; 1 er nøyaktig',
  mean_side_bias: 'hvordan det svinger når det skal rett fram; 0 er rett',
  mean_steering_zero: 'hvordan hjulene står når det skal rett fram',
  mean_compass_offset: 'hvor mye kompasset viser for mye',
  mean_compass_spread: 'hva som er igjen av feilen, etter kurs; lite er bra',
  mean_antennas_offset: 'hvor mye antennene peker til siden for rett fram',
} as const;
