-- Who did what, from where, and what was answered. Rows are only added; each one's hash holds the one
-- before it, so that a row which is changed or missing is found. The oldest go for the room: from
-- the start, and audit_cut keeps what the first one left hangs on.

CREATE TABLE audit (
  id         INTEGER NOT NULL PRIMARY KEY,
  time_ns    INTEGER NOT NULL,
  user       TEXT    NOT NULL,  -- empty: nobody known
  credential TEXT    NOT NULL,  -- "session 1f…", "token 2a…"; opens nothing
  address    TEXT    NOT NULL,
  call       TEXT    NOT NULL,  -- "PUT /missions/{id}"
  target     TEXT    NOT NULL,  -- "/missions/0123456789ab"
  status     INTEGER NOT NULL,
  detail     TEXT    NOT NULL,
  times      INTEGER NOT NULL CHECK (times > 0),
  hash       TEXT    NOT NULL
) STRICT;

CREATE TABLE audit_cut (
  one  INTEGER NOT NULL PRIMARY KEY CHECK (one = 1),
  id   INTEGER NOT NULL,
  hash TEXT    NOT NULL
) STRICT;
INSERT INTO audit_cut (one, id, hash) VALUES (1, 0, '');

CREATE TRIGGER audit_stays_as_it_is BEFORE UPDATE ON audit
BEGIN
  SELECT RAISE(ABORT, 'the audit is only added to');
END;

CREATE TRIGGER audit_goes_from_its_start BEFORE DELETE ON audit
WHEN OLD.id > (SELECT id FROM audit_cut)
BEGIN
  SELECT RAISE(ABORT, 'the audit is only cut at its start');
END;

CREATE TRIGGER audit_cut_goes_on BEFORE UPDATE ON audit_cut
WHEN NEW.id < OLD.id
BEGIN
  SELECT RAISE(ABORT, 'the cut of the audit only goes on');
END;

CREATE TRIGGER audit_cut_stays BEFORE DELETE ON audit_cut
BEGIN
  SELECT RAISE(ABORT, 'the audit has one cut');
END;
