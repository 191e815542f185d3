// The guide through a calibration drive.

export const guide = {
  purpose_drive:
    'Kuinka myöhään ja voimakkaasti se kääntyy, lähtee ja jarruttaa. Kun tämä tiedetään tarkasti, se pysähtyy oikeaan kohtaan eikä oio kulmia. Tee tämä uusien telojen tai renkaiden jälkeen, eri kuormalla tai jos se heilahtaa reitin yli.',
  purpose_steering:
    'Missä asennossa pyörät ovat, kun käsketään suoraan, ja kuinka myöhään ne kääntyvät. Tee tämä, jos se ajaa linjan vierellä aina samalla puolella.',
  purpose_compass:
    'Kuinka paljon kompassi on pielessä tässä paikassa. Vain tiedoksi: metalli lähellä muuttaa sen muualla.',
  purpose_antennas:
    'Kuinka vinossa kaksi antennia ovat. Tee tämä, jos se ajaa suoraan mutta nuoli kartalla osoittaa sivuun.',
  figure_drive:
    'Se ajaa kuusi 6 metrin suoraa edestakaisin ja kääntyy paikallaan; auto ajaa kierroksen kummallekin puolelle.',
  figure_steering: 'Se ajaa kierroksen kummallekin puolelle, 10 metrin suorilla.',
  figure_compass: 'Se kääntyy hitaasti kerran kummallekin puolelle; auto ajaa ympyrän.',
  figure_antennas: 'Se ajaa neljä suoraa edestakaisin.',
  stage_prepare: 'Valmistele',
  stage_drive: 'Aja',
  stage_judge: 'Arvioi',
  stages: 'Kalibroinnin vaiheet',
  guide_what_for: 'Mihin tämä on',
  guide_what_happens: 'Mitä tapahtuu',
  guide_before: 'Ennen kuin aloitat',
  guide_ground:
    'Tasainen, kova maa, jossa ei ole ketään eikä mitään edessä: kartalla rajattu alue. Jos raja on punainen, se ei voi alkaa: siirrä tai käännä robottia.',
  guide_stay: 'Pysy paikassa, josta näet koko alueen, sormi STOP-painikkeella.',
  guide_watch:
    'Katso, ettei kukaan astu rajatulle alueelle. HOLD tai STOP lopettaa heti; silloin mikään ei muutu.',
  guide_judge:
    'Vertaa ennen ja jälkeen. Jos tulosta on vaikea uskoa, hylkää se ja mittaa uudelleen; kahteen samaan tulokseen voi luottaa.',
  guide_keep:
    'Pidä: vaikuttaa heti ja 90 päivää, myös uudelleenkäynnistyksen jälkeen. Hylkää: ajaa kuten ennen.',
  guide_nothing_kept: 'Robotti ei käytä tästä mitään: lue ja sulje.',
  guide_what_now: 'Mitä tehdä',
  guide_figures: 'Mitä luvut tarkoittavat',
  ready_ground: 'Alue',
  ready_fits: 'mahtuu, kuten kartalla',
  ready_does_not_fit: 'ei mahdu tähän',
  ready_at_most: '{now}, enintään {most}',
  fail_position: 'Odota RTK-ratkaisua tai siirry avoimen taivaan alle ja aloita uudelleen.',
  fail_contradict:
    'Anturit ovat ristiriidassa keskenään: aja käsin muutama metri, kunnes tarkistukset ovat kunnossa, ja aloita uudelleen.',
  fail_heading: 'Aja käsin muutama metri suoraan ja aloita uudelleen.',
  fail_fence: 'Aja tai käännä robotti niin, että rajattu alue on aidan sisällä.',
  fail_slowed:
    'Jokin rajoitti nopeutta: tyhjennä alue, katso mitä kartan yllä lukee, ja aloita uudelleen.',
  fail_space: 'Se liukui alueelta: valitse kovempi maa ja enemmän tilaa.',
  fail_slope: 'Maa on liian kalteva: valitse tasainen paikka.',
  fail_obeys:
    'Se ei tottele ajoissa: tarkista akku, jarrut ja telat, kevennä kuormaa ja aloita uudelleen.',
  fail_other: 'Sulje, korjaa syy ja aloita uudelleen. Tähän asti mitattua ei käytetä.',
  mean_turn_delay: 'kääntymiskäskystä kääntymiseen',
  mean_drive_delay: 'ajokäskystä liikkeelle lähtöön',
  mean_braking: 'kuinka paljon hidastuu sekunnissa; enemmän on lyhyempi pysähdys',
  mean_acceleration: 'kuinka paljon kiihtyy sekunnissa',
  mean_speed_scale: 'ajetut metrit pyörien kertomaa metriä kohti; 1 on tarkka',
  mean_turn_scale: 'kääntyneet asteet käskettyä astetta kohti; 1 on tarkka',
  mean_side_bias: 'kuinka se kaartaa, kun käsketään suoraan; 0 on suora',
  mean_steering_zero: 'pyörien asento, kun käsketään suoraan',
  mean_compass_offset: 'paljonko kompassi näyttää liikaa',
  mean_compass_spread: 'mitä virheestä jää, suunnan mukaan; pieni on hyvä',
  mean_antennas_offset: 'kuinka paljon antennit osoittavat suoran sivuun',
} as const;
