-- About how much room a run takes, with its track and its events, so that their sum is bounded without
-- reading them all: a point counts as 100 bytes, an event as 100 and its text.

ALTER TABLE runs ADD COLUMN bytes INTEGER NOT NULL DEFAULT 0;

UPDATE runs SET bytes = 200 + length(CAST(plan AS BLOB)) + length(CAST(parameters AS BLOB))
  + 100 * ifnull((SELECT max(seq) FROM run_points WHERE run_id = runs.id), 0)
  + ifnull((SELECT sum(100 + length(CAST(detail AS BLOB))) FROM run_events WHERE run_id = runs.id), 0);
