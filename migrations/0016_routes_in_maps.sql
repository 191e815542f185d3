-- A node map may count from a map of the plane: its nodes are then metres of that map, by its name, as
-- the map points of a mission are. Such a one has no origin of its own; nodes of it that lie outdoors are
-- kept by latitude and longitude (x_m, y_m and theta_rad are then 0).

ALTER TABLE route_maps ADD COLUMN frame_map TEXT CHECK (frame_map IS NULL OR origin_lat IS NULL);
ALTER TABLE route_nodes ADD COLUMN lat REAL;
ALTER TABLE route_nodes ADD COLUMN lon REAL CHECK ((lat IS NULL) = (lon IS NULL));
