-- Missions by revision. A change never overwrites: it adds a revision, and the mission points at
-- the newest. A deletion is a revision without a plan, so that it can be undone.
-- Times are nanoseconds of UTC since 1970.

CREATE TABLE missions (
  id         TEXT    NOT NULL PRIMARY KEY,
  revision   INTEGER NOT NULL CHECK (revision >= 1),
  created_ns INTEGER NOT NULL,
  updated_ns INTEGER NOT NULL,
  name       TEXT    NOT NULL,
  items      INTEGER NOT NULL CHECK (items >= 0),
  length_m   REAL    NOT NULL CHECK (length_m >= 0),
  deleted    INTEGER NOT NULL DEFAULT 0 CHECK (deleted IN (0, 1)),
  FOREIGN KEY (id, revision) REFERENCES revisions (mission_id, revision)
    DEFERRABLE INITIALLY DEFERRED
) STRICT;

CREATE INDEX missions_by_update ON missions (updated_ns, id) WHERE deleted = 0;

CREATE TABLE revisions (
  mission_id TEXT    NOT NULL REFERENCES missions (id) DEFERRABLE INITIALLY DEFERRED,
  revision   INTEGER NOT NULL CHECK (revision >= 1),
  time_ns    INTEGER NOT NULL,
  author     TEXT    NOT NULL,
  what       TEXT    NOT NULL,
  name       TEXT    NOT NULL,
  items      INTEGER NOT NULL CHECK (items >= 0),
  length_m   REAL    NOT NULL CHECK (length_m >= 0),
  plan       TEXT,  -- JSON as in the public interface; NULL: this revision is the deletion
  PRIMARY KEY (mission_id, revision)
) STRICT;
