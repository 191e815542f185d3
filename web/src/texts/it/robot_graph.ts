// What the robot says of ways along a graph of nodes (texts/en/robot_graph.ts).

export const robot_graph = {
  rb_no_way_of_nodes: 'nessun percorso porta dal nodo {from} al nodo {to}',
  rb_no_way_out_of_map:
    'nessun percorso porta dal nodo {from} al nodo {to}: passerebbe fra luoghi sulla terra e la mappa «{map}», e nessuno sa dove questa stia sulla terra. Dalle un’ancora',
} as const;
