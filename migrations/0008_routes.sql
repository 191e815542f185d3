-- Node maps. Positions are as in the map: x along its heading, y to the left of it. Without an origin
-- the map lies indoors.

CREATE TABLE route_maps (
  number      INTEGER NOT NULL PRIMARY KEY AUTOINCREMENT,  -- newest last
  id          TEXT    NOT NULL UNIQUE,
  name        TEXT    NOT NULL,
  created_ns  INTEGER NOT NULL,
  origin_lat  REAL,
  origin_lon  REAL,
  heading_deg REAL    NOT NULL,
  home        INTEGER,
  nodes       INTEGER NOT NULL,
  links       INTEGER NOT NULL,
  CHECK ((origin_lat IS NULL) = (origin_lon IS NULL))
) STRICT;

CREATE TABLE route_nodes (
  map       INTEGER NOT NULL REFERENCES route_maps (number) ON DELETE CASCADE,
  node      INTEGER NOT NULL,
  x_m       REAL    NOT NULL,
  y_m       REAL    NOT NULL,
  theta_rad REAL    NOT NULL,
  PRIMARY KEY (map, node)
) STRICT, WITHOUT ROWID;

CREATE TABLE route_links (
  map       INTEGER NOT NULL,
  from_node INTEGER NOT NULL,
  to_node   INTEGER NOT NULL,
  PRIMARY KEY (map, from_node, to_node),
  FOREIGN KEY (map, from_node) REFERENCES route_nodes (map, node) ON DELETE CASCADE
) STRICT, WITHOUT ROWID;
