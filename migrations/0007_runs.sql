-- What was driven: one row a run, its track (5 Hz) and its events. A run is a mission from its start
-- to its end, pauses included. ended_ns NULL: still driven; at the next start of the program that
-- means its end was not seen (power cut), and it becomes outcome 'interrupted'.

CREATE TABLE runs (
  id         INTEGER PRIMARY KEY AUTOINCREMENT,
  begun_ns   INTEGER NOT NULL,
  ended_ns   INTEGER,
  outcome    TEXT    NOT NULL,  -- running finished aborted interrupted
  mission_id TEXT    NOT NULL,
  revision   INTEGER NOT NULL,
  name       TEXT    NOT NULL,
  vehicle    TEXT    NOT NULL,
  first_item INTEGER NOT NULL,
  plan       TEXT    NOT NULL,  -- JSON: the mission may be gone when the run is looked at
  parameters TEXT    NOT NULL   -- JSON: those that differed from their defaults
) STRICT;

CREATE TABLE run_points (
  run_id       INTEGER NOT NULL REFERENCES runs (id) ON DELETE CASCADE,
  seq          INTEGER NOT NULL,
  t_ns         INTEGER NOT NULL,  -- since the run began, by the robot's own clock
  lat          REAL    NOT NULL,
  lon          REAL    NOT NULL,
  yaw_rad      REAL    NOT NULL,
  speed_mps    REAL    NOT NULL,
  yaw_rate_radps REAL  NOT NULL,
  sigma_m      REAL    NOT NULL,
  cross_m      REAL,
  item         INTEGER,
  lap          INTEGER NOT NULL,
  power_w      REAL,
  by_itself    INTEGER NOT NULL,  -- 1: the program drove
  PRIMARY KEY (run_id, seq)
) STRICT, WITHOUT ROWID;

CREATE TABLE run_events (
  run_id INTEGER NOT NULL REFERENCES runs (id) ON DELETE CASCADE,
  seq    INTEGER NOT NULL,
  time_ns INTEGER NOT NULL,
  level  INTEGER NOT NULL CHECK (level BETWEEN 0 AND 2),
  kind   TEXT    NOT NULL,
  detail TEXT    NOT NULL,
  PRIMARY KEY (run_id, seq)
) STRICT, WITHOUT ROWID;

-- Where the mission stands that is in hand, so that a restart can go on with it. At most one row.
CREATE TABLE execution (
  id         INTEGER NOT NULL PRIMARY KEY CHECK (id = 1),
  time_ns    INTEGER NOT NULL,
  mission_id TEXT    NOT NULL,
  revision   INTEGER NOT NULL,
  name       TEXT    NOT NULL,
  item       INTEGER,
  items      INTEGER NOT NULL,
  place      TEXT    NOT NULL  -- JSON
) STRICT;

-- Parameters that were changed while the program ran; they hold over the configuration file.
CREATE TABLE parameters (
  name    TEXT    NOT NULL PRIMARY KEY,
  value   TEXT    NOT NULL,  -- JSON
  time_ns INTEGER NOT NULL
) STRICT;
