// Sentences of the robot that can wait: they are fetched once the page is live, for they have no room in its
// first load. A language brings its own beside these, by which they are found.

import { robot_around } from './robot_around';
import { robot_events } from './robot_events';
import { robot_files } from './robot_files';
import { robot_graph } from './robot_graph';

export const late = { ...robot_files, ...robot_around, ...robot_events, ...robot_graph } as const;
