// The guide through a calibration drive.

export const guide = {
  purpose_drive:
    'How late and how hard it turns, drives off and brakes. Known exactly, it stops where it shall and cuts no corners. Worth it after new tracks or tyres, with another load, or when it swings past its way.',
  purpose_steering:
    'Where its wheels stand when it is told straight, and how late they turn. Worth it when it drives beside its line, always to the same side.',
  purpose_compass:
    'By how much the compass is off at this place. It is told only: metal nearby makes it another one elsewhere.',
  purpose_antennas:
    'By how much the two antennas are mounted askew. Worth it when it drives straight, and its arrow on the map points aside.',
  figure_drive:
    'It drives six straights of 6 m, out and back, with turns on the spot; a car drives once round to each side.',
  figure_steering: 'It drives once round to each side, with straights of 10 m.',
  figure_compass: 'It turns slowly once to each side; a car drives a circle.',
  figure_antennas: 'It drives four straights, out and back.',
  stage_prepare: 'Prepare',
  stage_drive: 'Drive',
  stage_judge: 'Judge',
  stages: 'Steps of the calibration',
  guide_what_for: 'What it is for',
  guide_what_happens: 'What happens',
  guide_before: 'Before you begin',
  guide_ground:
    'Level, firm ground where nobody stands and nothing is in the way: the outlined area on the map. Where its outline is red it cannot begin: drive or turn the robot.',
  guide_stay: 'Stay where you see all of it, with a finger at STOP.',
  guide_watch:
    'Watch that nobody steps onto the outlined ground. HOLD or STOP end it at once; nothing is changed then.',
  guide_judge:
    'Compare before and after. What is hard to believe: discard it and measure once more; two drives that agree can be trusted.',
  guide_keep:
    'Keep: it acts at once and for 90 days, also after a restart. Discard: it drives as before.',
  guide_nothing_kept: 'Nothing of it is used by the robot: read it, then close it.',
  guide_what_now: 'What to do',
  guide_figures: 'What the figures mean',
  ready_ground: 'Ground',
  ready_fits: 'fits, as drawn on the map',
  ready_does_not_fit: 'does not fit here',
  ready_at_most: '{now}, at most {most}',
  fail_position:
    'Wait for RTK fixed, or go to where the antenna sees the open sky, and begin again.',
  fail_contradict:
    'Some sensors contradict each other: drive some metres by hand until the checks are well, and begin again.',
  fail_heading: 'Drive some metres straight ahead by hand, and begin again.',
  fail_fence: 'Drive or turn the robot so that the outlined ground lies inside the fence.',
  fail_slowed:
    'Something limited its speed: clear the ground, look at what stands above the map, and begin again.',
  fail_space: 'It slid out of its ground: choose firmer ground with more room around.',
  fail_slope: 'The ground leans too much: choose level ground.',
  fail_obeys:
    'It does not do in time what it is told: look at battery, brakes and tracks, take load off, and begin again.',
  fail_other:
    'Close it, set right what the reason says, and begin again. What was measured so far is not used.',
  mean_turn_delay: 'from the command to turn until it turns',
  mean_drive_delay: 'from the command to drive until it drives',
  mean_braking: 'by how much it slows each second; more is shorter stops',
  mean_acceleration: 'by how much it speeds up each second',
  mean_speed_scale: 'metres driven for each metre that the wheels tell; 1 is exact',
  mean_turn_scale: 'degrees turned for each degree that was told; 1 is exact',
  mean_side_bias: 'how it bends when told straight; 0 is straight',
  mean_steering_zero: 'where the wheels stand when told straight',
  mean_compass_offset: 'what the compass shows too much',
  mean_compass_spread: 'what is left of its error, by heading; small is good',
  mean_antennas_offset: 'by how much both antennas point aside of straight ahead',
} as const;
