-- Deleted missions are listed, newest deletion first, and forgotten when their time is over.
-- deleted_at is `updated_ns` of a mission whose newest revision is its deletion.

CREATE INDEX missions_by_deletion ON missions (updated_ns, id) WHERE deleted = 1;
