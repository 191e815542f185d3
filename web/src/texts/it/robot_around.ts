// What the robot says of a way around what stands in its way (texts/en/robot_around.ts).

export const robot_around = {
  rb_no_gap: 'nessun varco è abbastanza largo',
  rb_goes_on_beyond: 'ciò che sta lì prosegue oltre quanto si guarda',
  rb_corridor_no_way: 'il corridoio non lascia passaggio',
  rb_fence_no_way: 'il recinto non lascia passaggio',
  rb_around_unseen: 'il percorso attraversa ciò che nessun sensore ha visto',
  rb_too_narrow_turn: 'il veicolo non può svoltare stretto quanto dovrebbe',
  rb_stands_in_it: 'il veicolo sta dentro ciò che lo blocca',
  rb_target_in_it: 'ciò a cui porta il percorso sta in ciò che lo blocca',
  rb_no_way_in_time: 'non si è trovato un passaggio in tempo',
  rb_item_in_it: 'l’elemento {n} sta in ciò che si trova lì',
  rb_no_way_around: 'nessuna via per aggirarlo: {why}',
  rb_around_not_driven: 'la via per aggirarlo non si è potuta percorrere',
  rb_turns_to_look: 'gira sul posto per cercare una via intorno a ciò che sta lì',
  rb_around_left: 'intorno a ciò che sta lì, a sinistra, {n} m',
  rb_around_right: 'intorno a ciò che sta lì, a destra, {n} m',
} as const;
