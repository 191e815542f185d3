// What the robot says of a way around what stands in its way: that it takes one, or why there is none.

export const robot_around = {
  rb_no_gap: 'no gap is wide enough',
  rb_goes_on_beyond: 'what stands there goes on beyond what is looked at',
  rb_corridor_no_way: 'the corridor leaves no way',
  rb_fence_no_way: 'the fence leaves no way',
  rb_around_unseen: 'the way leads through what no sensor has seen',
  rb_too_narrow_turn: 'the vehicle cannot turn as narrowly as it would have to',
  rb_stands_in_it: 'the vehicle stands in what blocks it',
  rb_target_in_it: 'what the route leads to lies in what blocks it',
  rb_no_way_in_time: 'no way was found in time',
  rb_item_in_it: 'item {n} lies in what stands there',
  rb_no_way_around: 'no way around it: {why}',
  rb_around_not_driven: 'the way around could not be driven',
  rb_turns_to_look: 'it turns on the spot to look for a way around what stands there',
  rb_around_left: 'around what stands there, on the left, {n} m',
  rb_around_right: 'around what stands there, on the right, {n} m',
} as const;
