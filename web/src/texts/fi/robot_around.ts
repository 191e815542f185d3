// What the robot says of a way around what stands in its way (texts/en/robot_around.ts).

export const robot_around = {
  rb_no_gap: 'mikään väli ei ole tarpeeksi leveä',
  rb_goes_on_beyond: 'se, mikä siellä on, jatkuu kauemmas kuin katsotaan',
  rb_corridor_no_way: 'käytävä ei jätä tietä',
  rb_fence_no_way: 'aita ei jätä tietä',
  rb_around_unseen: 'tie vie sen läpi, mitä mikään anturi ei ole nähnyt',
  rb_too_narrow_turn: 'ajoneuvo ei käänny niin jyrkästi kuin pitäisi',
  rb_stands_in_it: 'ajoneuvo seisoo siinä, mikä sen estää',
  rb_target_in_it: 'se, mihin reitti johtaa, on esteessä',
  rb_no_way_in_time: 'tietä ei löytynyt ajoissa',
  rb_item_in_it: 'kohta {n} on siinä, mikä siellä seisoo',
  rb_no_way_around: 'kiertotietä ei ole: {why}',
  rb_around_not_driven: 'kiertotietä ei voitu ajaa',
  rb_turns_to_look: 'se kääntyy paikallaan etsiäkseen kiertotietä',
  rb_around_left: 'ohi siitä, mikä siellä seisoo, vasemmalta, {n} m',
  rb_around_right: 'ohi siitä, mikä siellä seisoo, oikealta, {n} m',
} as const;
