-- The recording of a driven way, while it is made: at most one. What was recorded becomes a mission
-- and goes from here in one transaction. Found at a start, it was interrupted.

CREATE TABLE teach (
  id          INTEGER NOT NULL PRIMARY KEY CHECK (id = 1),
  started_ns  INTEGER NOT NULL,
  name        TEXT    NOT NULL,
  step_m      REAL    NOT NULL,
  heading_deg REAL    NOT NULL,
  tolerance_m REAL    NOT NULL,
  sigma_max_m REAL    NOT NULL
) STRICT;

CREATE TABLE teach_points (
  number      INTEGER NOT NULL PRIMARY KEY,  -- 1, 2, 3 … in the order of driving
  lat         REAL    NOT NULL,
  lon         REAL    NOT NULL,
  heading_deg REAL    NOT NULL,
  speed_mps   REAL    NOT NULL CHECK (speed_mps >= 0),
  reverse     INTEGER NOT NULL CHECK (reverse IN (0, 1)),
  gap         INTEGER NOT NULL CHECK (gap IN (0, 1))
) STRICT;
