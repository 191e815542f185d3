-- Order among many missions: tags, an archive, and names that are found whatever their case.
-- fold() is the program's own: mission::folded.

ALTER TABLE missions ADD COLUMN archived INTEGER NOT NULL DEFAULT 0 CHECK (archived IN (0, 1));
-- The name as it is searched for.
ALTER TABLE missions ADD COLUMN search TEXT NOT NULL DEFAULT '';
UPDATE missions SET search = fold(name);

-- A page of a list is looked for in one of these alone, whatever else there is. The last two columns
-- are always the same: without them the table would be looked into for them.
DROP INDEX missions_by_update;
CREATE INDEX missions_in_use ON missions (updated_ns, id, search, deleted, archived)
  WHERE deleted = 0 AND archived = 0;
CREATE INDEX missions_in_archive ON missions (updated_ns, id, search, deleted, archived)
  WHERE deleted = 0 AND archived = 1;

-- updated_ns is the mission's, so that a tag's missions are listed in the same order.
CREATE TABLE mission_tags (
  tag        TEXT    NOT NULL,
  updated_ns INTEGER NOT NULL,
  mission_id TEXT    NOT NULL REFERENCES missions (id) ON DELETE CASCADE,
  PRIMARY KEY (tag, updated_ns, mission_id)
) STRICT, WITHOUT ROWID;
CREATE INDEX tags_of_mission ON mission_tags (mission_id, tag);
