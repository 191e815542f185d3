// Sentences of the robot that can wait (texts/en/late.ts).

import { robot_around } from './robot_around';
import { robot_events } from './robot_events';
import { robot_files } from './robot_files';
import { robot_graph } from './robot_graph';

export const late = { ...robot_files, ...robot_around, ...robot_events, ...robot_graph } as const;
