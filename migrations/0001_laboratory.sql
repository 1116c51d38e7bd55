-- Times are nanoseconds since the Unix epoch, UTC. Lengths are metres.

CREATE TABLE users (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    username TEXT NOT NULL COLLATE NOCASE UNIQUE CHECK (length(username) BETWEEN 1 AND 64),
    display_name TEXT NOT NULL CHECK (length(display_name) BETWEEN 1 AND 128),
    role TEXT NOT NULL CHECK (role IN ('student', 'assistant', 'instructor', 'staff', 'admin')),
    password_hash TEXT NOT NULL CHECK (password_hash LIKE '$argon2id$%'),
    must_change_password INTEGER NOT NULL CHECK (must_change_password IN (0, 1)),
    created_ns INTEGER NOT NULL
) STRICT;

-- The cookie's token itself is never stored.
CREATE TABLE sessions (
    token_hash TEXT PRIMARY KEY NOT NULL,
    csrf_token TEXT NOT NULL,
    user_id INTEGER NOT NULL REFERENCES users (id) ON DELETE CASCADE,
    created_ns INTEGER NOT NULL,
    expires_ns INTEGER NOT NULL CHECK (expires_ns > created_ns)
) STRICT, WITHOUT ROWID;

CREATE INDEX sessions_by_user ON sessions (user_id);
CREATE INDEX sessions_by_expiry ON sessions (expires_ns);

CREATE TABLE bookings (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    rig TEXT NOT NULL CHECK (rig <> ''),
    experiment TEXT NOT NULL CHECK (experiment <> ''),
    user_id INTEGER NOT NULL REFERENCES users (id),
    start_ns INTEGER NOT NULL CHECK (start_ns % 300000000000 = 0),
    end_ns INTEGER NOT NULL CHECK (end_ns % 300000000000 = 0),
    created_ns INTEGER NOT NULL,
    cancelled_ns INTEGER,
    -- No slot is longer than a day: this bounds every search for what touches a time.
    CHECK (end_ns > start_ns AND end_ns - start_ns <= 86400000000000)
) STRICT;

CREATE INDEX bookings_by_rig ON bookings (rig, start_ns) WHERE cancelled_ns IS NULL;
CREATE INDEX bookings_by_user ON bookings (user_id, end_ns) WHERE cancelled_ns IS NULL;

-- The last line of defence: whatever the program does, no two people get one rig at one time.
CREATE TRIGGER bookings_never_overlap BEFORE INSERT ON bookings
WHEN NEW.cancelled_ns IS NULL AND EXISTS (
    SELECT 1 FROM bookings
    WHERE rig = NEW.rig AND cancelled_ns IS NULL AND start_ns < NEW.end_ns
        AND start_ns > NEW.start_ns - 86400000000000 AND end_ns > NEW.start_ns
)
BEGIN
    SELECT RAISE(ABORT, 'bookings overlap');
END;

CREATE TRIGGER bookings_never_move_onto_another BEFORE UPDATE ON bookings
WHEN NEW.cancelled_ns IS NULL AND EXISTS (
    SELECT 1 FROM bookings
    WHERE rig = NEW.rig AND cancelled_ns IS NULL AND start_ns < NEW.end_ns
        AND start_ns > NEW.start_ns - 86400000000000 AND end_ns > NEW.start_ns AND id <> NEW.id
)
BEGIN
    SELECT RAISE(ABORT, 'bookings overlap');
END;

CREATE TABLE runs (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    rig TEXT NOT NULL CHECK (rig <> ''),
    experiment TEXT NOT NULL CHECK (experiment <> ''),
    user_id INTEGER NOT NULL REFERENCES users (id),
    booking_id INTEGER NOT NULL REFERENCES bookings (id),
    state TEXT NOT NULL CHECK (state IN (
        'preparing', 'ready', 'releasing', 'measuring', 'analysing',
        'completed', 'aborted', 'failed', 'interrupted'
    )),
    reason TEXT NOT NULL DEFAULT '',
    parameters TEXT NOT NULL CHECK (json_valid(parameters)),
    definition TEXT NOT NULL CHECK (json_valid(definition)),
    duration_s REAL NOT NULL CHECK (duration_s > 0),
    created_ns INTEGER NOT NULL,
    started_ns INTEGER,
    ended_ns INTEGER,
    frames INTEGER NOT NULL DEFAULT 0 CHECK (frames >= 0),
    frames_lost INTEGER NOT NULL DEFAULT 0 CHECK (frames_lost >= 0),
    CHECK ((ended_ns IS NOT NULL) = (state IN ('completed', 'aborted', 'failed', 'interrupted')))
) STRICT;

CREATE INDEX runs_by_user ON runs (user_id, id);
CREATE INDEX runs_by_rig ON runs (rig, id);
CREATE INDEX runs_by_booking ON runs (booking_id);
-- A rig does one run at a time.
CREATE UNIQUE INDEX runs_one_open_for_each_rig ON runs (rig)
WHERE state IN ('preparing', 'ready', 'releasing', 'measuring', 'analysing');

CREATE TABLE run_states (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    run_id INTEGER NOT NULL REFERENCES runs (id) ON DELETE CASCADE,
    at_ns INTEGER NOT NULL,
    state TEXT NOT NULL,
    cause TEXT NOT NULL,
    person INTEGER REFERENCES users (id)
) STRICT;

CREATE INDEX run_states_by_run ON run_states (run_id, id);

-- One row for each object and frame, in the lab frame; NULL where an object was lost.
-- s*: standard uncertainties, c*: covariances (m²) of the position.
CREATE TABLE poses (
    run_id INTEGER NOT NULL REFERENCES runs (id) ON DELETE CASCADE,
    object TEXT NOT NULL,
    t_ns INTEGER NOT NULL,
    status INTEGER NOT NULL CHECK (status IN (0, 1, 2)),
    has_orientation INTEGER NOT NULL CHECK (has_orientation IN (0, 1)),
    x REAL, y REAL, z REAL,
    qx REAL, qy REAL, qz REAL, qw REAL,
    sx REAL, sy REAL, sz REAL,
    cxy REAL, cxz REAL, cyz REAL,
    vx REAL, vy REAL, vz REAL,
    wx REAL, wy REAL, wz REAL,
    points INTEGER NOT NULL,
    inlier_share REAL,
    rms_steps REAL,
    PRIMARY KEY (run_id, object, t_ns)
) STRICT, WITHOUT ROWID;

-- A later analysis of the same run is another version; none is ever overwritten.
CREATE TABLE results (
    run_id INTEGER NOT NULL REFERENCES runs (id) ON DELETE CASCADE,
    version INTEGER NOT NULL CHECK (version >= 1),
    created_ns INTEGER NOT NULL,
    result TEXT NOT NULL CHECK (json_valid(result)),
    fit TEXT NOT NULL CHECK (json_valid(fit)),
    warnings TEXT NOT NULL CHECK (json_valid(warnings)),
    PRIMARY KEY (run_id, version)
) STRICT, WITHOUT ROWID;
