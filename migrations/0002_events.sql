-- What an operator must be able to find later. Ids rise without gaps, so the oldest can be trimmed
-- by number. level: 0 info, 1 warning, 2 error.

CREATE TABLE events (
  id      INTEGER PRIMARY KEY AUTOINCREMENT,
  time_ns INTEGER NOT NULL,
  level   INTEGER NOT NULL CHECK (level BETWEEN 0 AND 2),
  kind    TEXT    NOT NULL,
  detail  TEXT    NOT NULL
) STRICT;

-- The rare ones are found without reading all the others.
CREATE INDEX events_warning ON events (id) WHERE level >= 1;
CREATE INDEX events_error ON events (id) WHERE level >= 2;
