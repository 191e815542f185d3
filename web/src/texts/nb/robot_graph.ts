// What the robot says of ways along a graph of nodes (texts/en/robot_graph.ts).

export const robot_graph = {
  rb_no_way_of_nodes: 'ingen vei fører fra node {from} til node {to}',
  rb_no_way_out_of_map:
    'ingen vei fører fra node {from} til node {to}: den ville gå mellom steder på jorden og kartet «{map}», og ingen vet hvor på jorden det ligger. Gi det et anker',
} as const;
