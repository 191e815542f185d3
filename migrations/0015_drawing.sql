-- From here on the plan of a revision may have a member `drawing` (what its items were drawn as). No table
-- changes; but a program that does not know it could not read such a revision, so it must not open this file.

SELECT 1;
