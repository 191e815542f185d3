// What the robot says of a way around what stands in its way (texts/en/robot_around.ts).

export const robot_around = {
  rb_no_gap: 'ükski vahe pole küllalt lai',
  rb_goes_on_beyond: 'mis seal seisab, jätkub kaugemale, kui vaadatakse',
  rb_corridor_no_way: 'koridor ei jäta teed',
  rb_fence_no_way: 'piir ei jäta teed',
  rb_around_unseen: 'tee viib läbi selle, mida ükski andur pole näinud',
  rb_too_narrow_turn: 'sõiduk ei saa pöörata nii järsult, kui vaja',
  rb_stands_in_it: 'sõiduk seisab selle sees, mis teda takistab',
  rb_target_in_it: 'see, kuhu tee viib, asub takistuse sees',
  rb_no_way_in_time: 'õigel ajal teed ei leitud',
  rb_item_in_it: 'koht {n} asub selle sees, mis seal seisab',
  rb_no_way_around: 'möödapääsu pole: {why}',
  rb_around_not_driven: 'möödapääsu ei saanud sõita',
  rb_turns_to_look: 'see pöörab kohapeal, et otsida möödapääsu sellest, mis seal seisab',
  rb_around_left: 'mööda sellest, mis seal seisab, vasakult, {n} m',
  rb_around_right: 'mööda sellest, mis seal seisab, paremalt, {n} m',
} as const;
