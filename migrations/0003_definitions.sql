-- The plots of an analysis, as the page and the report draw them; and who had it made, NULL for the
-- one that ends a run. A fit names its object since several can be tracked at once.
ALTER TABLE results ADD COLUMN plots TEXT NOT NULL DEFAULT '[]' CHECK (json_valid(plots));
ALTER TABLE results ADD COLUMN person INTEGER REFERENCES users (id);
UPDATE results SET fit = json_object('objects', json_array(json_set(fit, '$.object', 'bob')))
WHERE json_type(fit, '$.objects') IS NULL;

-- Experiments that instructors made. A published version never changes and never goes: runs were
-- made with it. A draft (published_ns NULL) is seen by its owner only.
CREATE TABLE definitions (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    experiment TEXT NOT NULL CHECK (length(experiment) BETWEEN 1 AND 64),
    version INTEGER NOT NULL CHECK (version >= 1),
    owner INTEGER NOT NULL REFERENCES users (id),
    definition TEXT NOT NULL CHECK (json_valid(definition)),
    created_ns INTEGER NOT NULL,
    published_ns INTEGER,
    retired_ns INTEGER,
    UNIQUE (experiment, version)
) STRICT;

CREATE INDEX definitions_by_owner ON definitions (owner, id);

-- Covariance of the orientation as a rotation vector in the lab frame (rad²); NULL where there is
-- no orientation.
ALTER TABLE poses ADD COLUMN rxx REAL;
ALTER TABLE poses ADD COLUMN ryy REAL;
ALTER TABLE poses ADD COLUMN rzz REAL;
ALTER TABLE poses ADD COLUMN rxy REAL;
ALTER TABLE poses ADD COLUMN rxz REAL;
ALTER TABLE poses ADD COLUMN ryz REAL;
