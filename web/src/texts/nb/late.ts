// Sentences of the robot that can wait (texts/en/late.ts).

import { robot_around } from './robot_around';
import { robot_files } from './robot_files';

export const late = { ...robot_files, ...robot_around } as const;
