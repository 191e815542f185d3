-- Paired devices: what a browser keeps for a year, and with it a PIN makes a session. The secret
-- alone opens nothing, and neither does the PIN; of both there is only a hash. A session that a PIN
-- made goes with its device.

CREATE TABLE devices (
  id         TEXT    NOT NULL PRIMARY KEY,
  hash       TEXT    NOT NULL UNIQUE,  -- of its cookie
  user       TEXT    NOT NULL REFERENCES users (name) ON DELETE CASCADE,
  name       TEXT    NOT NULL,
  role       TEXT    NOT NULL CHECK (role IN ('viewer', 'operator', 'admin')),  -- at most
  pin        TEXT    NOT NULL,         -- argon2id
  wrong      INTEGER NOT NULL CHECK (wrong >= 0),  -- PINs, one after the other
  created_ns INTEGER NOT NULL,
  used_ns    INTEGER
) STRICT;

ALTER TABLE sessions ADD COLUMN paired TEXT REFERENCES devices (id) ON DELETE CASCADE;

CREATE INDEX devices_of_user ON devices (user);
CREATE INDEX sessions_of_device ON sessions (paired);
