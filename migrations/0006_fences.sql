-- Fences by revision, as the missions: a change adds one, a deletion is one without a body. At most
-- one fence is the active one.

CREATE TABLE fences (
  id         TEXT    NOT NULL PRIMARY KEY,
  revision   INTEGER NOT NULL CHECK (revision >= 1),
  created_ns INTEGER NOT NULL,
  updated_ns INTEGER NOT NULL,
  name       TEXT    NOT NULL,
  areas      INTEGER NOT NULL CHECK (areas >= 0),
  rally      INTEGER NOT NULL CHECK (rally >= 0),
  deleted    INTEGER NOT NULL DEFAULT 0 CHECK (deleted IN (0, 1)),
  active     INTEGER NOT NULL DEFAULT 0 CHECK (active IN (0, 1) AND NOT (active AND deleted)),
  FOREIGN KEY (id, revision) REFERENCES fence_revisions (fence_id, revision)
    DEFERRABLE INITIALLY DEFERRED
) STRICT;

CREATE INDEX fences_by_update ON fences (updated_ns, id) WHERE deleted = 0;
CREATE UNIQUE INDEX fences_active ON fences (active) WHERE active = 1;

CREATE TABLE fence_revisions (
  fence_id TEXT    NOT NULL REFERENCES fences (id) DEFERRABLE INITIALLY DEFERRED,
  revision INTEGER NOT NULL CHECK (revision >= 1),
  time_ns  INTEGER NOT NULL,
  author   TEXT    NOT NULL,
  what     TEXT    NOT NULL,
  name     TEXT    NOT NULL,
  packed   BLOB,  -- zstd of the JSON of the public interface; NULL: the deletion
  PRIMARY KEY (fence_id, revision)
) STRICT;
