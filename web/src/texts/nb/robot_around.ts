// What the robot says of a way around what stands in its way (texts/en/robot_around.ts).

export const robot_around = {
  rb_no_gap: 'ingen åpning er bred nok',
  rb_goes_on_beyond: 'det som står der, fortsetter lenger enn det ses',
  rb_corridor_no_way: 'korridoren lar ingen vei være',
  rb_fence_no_way: 'gjerdet lar ingen vei være',
  rb_around_unseen: 'veien går gjennom det ingen sensor har sett',
  rb_too_narrow_turn: 'kjøretøyet kan ikke svinge så krapt som det måtte',
  rb_stands_in_it: 'kjøretøyet står i det som sperrer',
  rb_target_in_it: 'det ruten fører til, ligger i det som sperrer',
  rb_no_way_in_time: 'ingen vei ble funnet i tide',
  rb_item_in_it: 'punkt {n} ligger i det som står der',
  rb_no_way_around: 'ingen vei rundt det: {why}',
  rb_around_not_driven: 'veien rundt kunne ikke kjøres',
  rb_turns_to_look: 'den snur på stedet for å lete etter en vei rundt det som står der',
  rb_around_left: 'rundt det som står der, til venstre, {n} m',
  rb_around_right: 'rundt det som står der, til høyre, {n} m',
} as const;
