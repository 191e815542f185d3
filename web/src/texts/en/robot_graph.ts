// What the robot says of ways along a graph of nodes.

export const robot_graph = {
  rb_no_way_of_nodes: 'no way leads from node {from} to node {to}',
  rb_no_way_out_of_map:
    'no way leads from node {from} to node {to}: it would lead between places on the earth and the map "{map}", and nobody knows where on the earth that lies. Give it an anchor',
} as const;
