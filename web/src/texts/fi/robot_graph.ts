// What the robot says of ways along a graph of nodes (texts/en/robot_graph.ts).

export const robot_graph = {
  rb_no_way_of_nodes: 'solmusta {from} solmuun {to} ei ole reittiä',
  rb_no_way_out_of_map:
    'solmusta {from} solmuun {to} ei ole reittiä: se kulkisi maan ja kartan ”{map}” välillä, eikä kukaan tiedä, missä kartta maan päällä on. Anna sille ankkuri',
} as const;
