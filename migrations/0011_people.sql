-- Who may come in. No secret that opens a door is here: of passwords there is argon2id, of cookies
-- and tokens a hash. Times are UTC by this computer's clock, which may not have been set.

CREATE TABLE users (
  name       TEXT    NOT NULL PRIMARY KEY,
  role       TEXT    NOT NULL CHECK (role IN ('viewer', 'operator', 'admin')),
  password   TEXT    NOT NULL,
  created_ns INTEGER NOT NULL
) STRICT;

CREATE TABLE sessions (
  id         TEXT    NOT NULL PRIMARY KEY,
  hash       TEXT    NOT NULL UNIQUE,
  user       TEXT    NOT NULL REFERENCES users (name) ON DELETE CASCADE,
  device     TEXT    NOT NULL,
  address    TEXT    NOT NULL,
  created_ns INTEGER NOT NULL,
  seen_ns    INTEGER NOT NULL
) STRICT;

CREATE TABLE tokens (
  id         TEXT    NOT NULL PRIMARY KEY,
  hash       TEXT    NOT NULL UNIQUE,
  name       TEXT    NOT NULL,
  user       TEXT    NOT NULL REFERENCES users (name) ON DELETE CASCADE,
  role       TEXT    NOT NULL CHECK (role IN ('viewer', 'operator', 'admin')),
  methods    TEXT    NOT NULL,  -- with blanks between them; empty: all
  created_ns INTEGER NOT NULL,
  expires_ns INTEGER,
  used_ns    INTEGER
) STRICT;

CREATE INDEX sessions_of_user ON sessions (user);
CREATE INDEX tokens_of_user ON tokens (user);
