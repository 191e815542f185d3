-- Where the robot slipped, slid aside or dug itself in. A bounded number: the newest places stay.

CREATE TABLE slips (
  id      INTEGER PRIMARY KEY AUTOINCREMENT,
  lat     REAL    NOT NULL,
  lon     REAL    NOT NULL,
  time_ns INTEGER NOT NULL,                        -- the last time
  kind    INTEGER NOT NULL CHECK (kind BETWEEN 0 AND 2),  -- slip, side, dug
  percent REAL    NOT NULL,                        -- the most
  times   INTEGER NOT NULL CHECK (times >= 1)
) STRICT;

CREATE INDEX slips_by_time ON slips (time_ns, id);
CREATE INDEX slips_by_place ON slips (kind, lat);
