-- When a run that is ready is given up unless somebody releases it; NULL for runs made before.
ALTER TABLE runs ADD COLUMN release_until_ns INTEGER;
