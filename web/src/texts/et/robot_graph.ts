// What the robot says of ways along a graph of nodes (texts/en/robot_graph.ts).

export const robot_graph = {
  rb_no_way_of_nodes: 'sõlmest {from} sõlme {to} ei vii ükski tee',
  rb_no_way_out_of_map:
    'sõlmest {from} sõlme {to} ei vii ükski tee: see viiks maa ja kaardi „{map}“ vahel, aga keegi ei tea, kus see kaart maa peal asub. Anna sellele ankur',
} as const;
