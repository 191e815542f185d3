-- Revisions are kept packed: zstd of the plan's JSON, against that of an earlier, whole revision
-- where that is shorter, so that a revision costs what was changed. `plan` holds those written
-- before; all three empty: this revision is the deletion.

ALTER TABLE revisions ADD COLUMN packed BLOB;
-- The revision of the same mission whose plan is the prefix; NULL: packed as a whole.
ALTER TABLE revisions ADD COLUMN base INTEGER CHECK (base IS NULL OR base < revision);
