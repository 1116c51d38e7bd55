#include "server/store/runs.hpp"

#include <algorithm>

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>
#include <nlohmann/json.hpp>

namespace kinectlab::store {
namespace {

constexpr const char* kColumns =
    "SELECT r.id, r.rig, r.experiment, r.user_id, u.display_name, r.booking_id, r.state, r.reason, "
    "r.parameters, r.definition, r.duration_s, r.created_ns, r.started_ns, r.ended_ns, r.frames, "
    "r.frames_lost, s.result, s.warnings, r.release_until_ns FROM runs r "
    "JOIN users u ON u.id = r.user_id LEFT JOIN results s ON s.run_id = r.id AND s.version = "
    "(SELECT max(version) FROM results WHERE run_id = r.id) WHERE ";

std::optional<TimeNs> optional_time(const SQLite::Column& column) {
    if (column.isNull()) return std::nullopt;
    return column.getInt64();
}

lab::Run read_run(SQLite::Statement& row) {
    lab::Run run{
        .id = row.getColumn(0).getInt64(),
        .rig = row.getColumn(1).getString(),
        .experiment = row.getColumn(2).getString(),
        .user = row.getColumn(3).getInt64(),
        .user_name = row.getColumn(4).getString(),
        .booking = row.getColumn(5).getInt64(),
        .state = lab::run_state_from_text(row.getColumn(6).getString()).value(),
        .reason = row.getColumn(7).getString(),
        .parameters = nlohmann::json::parse(row.getColumn(8).getString()),
        .definition_json = row.getColumn(9).getString(),
        .duration_s = row.getColumn(10).getDouble(),
        .created = row.getColumn(11).getInt64(),
        .release_until = optional_time(row.getColumn(18)),
        .started = optional_time(row.getColumn(12)),
        .ended = optional_time(row.getColumn(13)),
        .frames = row.getColumn(14).getInt64(),
        .frames_lost = row.getColumn(15).getInt64(),
    };
    if (!row.getColumn(16).isNull()) {
        run.result_json = row.getColumn(16).getString();
        run.warnings = nlohmann::json::parse(row.getColumn(17).getString());
    }
    return run;
}

std::optional<lab::Run> select_one(SQLite::Database& connection, lab::RunId id) {
    SQLite::Statement query(connection, std::string(kColumns) + "r.id = ?");
    query.bind(1, id);
    if (!query.executeStep()) return std::nullopt;
    return read_run(query);
}

void bind_optional(SQLite::Statement& statement, int index, std::optional<std::int64_t> value) {
    if (value) {
        statement.bind(index, *value);
    } else {
        statement.bind(index);
    }
}

void add_change(SQLite::Database& connection, const lab::RunChange& change) {
    SQLite::Statement insert(
        connection,
        "INSERT INTO run_states (run_id, at_ns, state, cause, person) VALUES (?, ?, ?, ?, ?)"
    );
    SQLite::bind(insert, change.run, change.at, std::string(to_text(change.state)), change.cause);
    bind_optional(insert, 5, change.person);
    insert.exec();
}

}  // namespace

Result<lab::Run> RunRepository::add(const lab::Run& run) {
    Database::Transaction transaction(database_);
    auto& connection = transaction.connection();
    SQLite::Statement open(connection, "SELECT id FROM runs WHERE rig = ? AND ended_ns IS NULL");
    open.bind(1, run.rig);
    if (open.executeStep()) {
        return fail(
            ErrorCode::conflict,
            "rig",
            "run " + open.getColumn(0).getString() + " is under way on it",
            "wait until it is over"
        );
    }
    SQLite::Statement insert(
        connection,
        "INSERT INTO runs (rig, experiment, user_id, booking_id, state, parameters, definition, "
        "duration_s, created_ns, release_until_ns) "
        "VALUES (?, ?, ?, ?, 'preparing', ?, ?, ?, ?, ?)"
    );
    SQLite::bind(
        insert,
        run.rig,
        run.experiment,
        run.user,
        run.booking,
        nlohmann::json(run.parameters).dump(),
        run.definition_json,
        run.duration_s,
        run.created
    );
    bind_optional(insert, 9, run.release_until);
    insert.exec();
    const lab::RunId id = connection.getLastInsertRowid();
    add_change(connection, {id, run.created, lab::RunState::preparing, "Started", run.user});
    auto stored = select_one(connection, id).value();
    transaction.commit();
    return stored;
}

Result<lab::Run> RunRepository::advance(lab::RunId id, const RunStep& step) {
    Database::Transaction transaction(database_);
    auto& connection = transaction.connection();
    auto run = select_one(connection, id);
    if (!run) return fail(ErrorCode::not_found, "run", "there is no run " + std::to_string(id));
    const auto state = lab::next(run->state, step.event);
    if (!state) return tl::unexpected(state.error());

    run->state = *state;
    if (*state == lab::RunState::measuring) run->started = step.at;
    if (lab::is_final(*state)) run->ended = step.at;
    if (lab::is_final(*state) && *state != lab::RunState::completed) run->reason = step.cause;

    SQLite::Statement update(
        connection,
        "UPDATE runs SET state = ?, reason = ?, started_ns = ?, ended_ns = ? WHERE id = ?"
    );
    SQLite::bind(update, std::string(to_text(*state)), run->reason);
    bind_optional(update, 3, run->started);
    bind_optional(update, 4, run->ended);
    update.bind(5, id);
    update.exec();
    add_change(connection, {id, step.at, *state, step.cause, step.person});
    transaction.commit();
    return *run;
}

void RunRepository::set_frames(lab::RunId id, std::int64_t frames, std::int64_t lost) {
    Database::Transaction transaction(database_);
    SQLite::Statement update(
        transaction.connection(), "UPDATE runs SET frames = ?, frames_lost = ? WHERE id = ?"
    );
    SQLite::bind(update, frames, lost, id);
    update.exec();
    transaction.commit();
}

std::optional<lab::Run> RunRepository::find(lab::RunId id) {
    Database::Reader reader(database_);
    return select_one(reader.connection(), id);
}

std::vector<lab::Run> RunRepository::list(const RunFilter& filter) {
    std::string condition = "1";
    if (filter.user) condition += " AND r.user_id = :user";
    if (filter.rig) condition += " AND r.rig = :rig";
    if (filter.before) condition += " AND r.id < :before";
    Database::Reader reader(database_);
    SQLite::Statement query(
        reader.connection(), kColumns + condition + " ORDER BY r.id DESC LIMIT :limit"
    );
    if (filter.user) query.bind(":user", *filter.user);
    if (filter.rig) query.bind(":rig", *filter.rig);
    if (filter.before) query.bind(":before", *filter.before);
    query.bind(":limit", std::max(filter.limit, 0));
    std::vector<lab::Run> runs;
    while (query.executeStep())
        runs.push_back(read_run(query));
    return runs;
}

std::vector<lab::RunChange> RunRepository::history(lab::RunId id) {
    Database::Reader reader(database_);
    SQLite::Statement query(
        reader.connection(),
        "SELECT run_id, at_ns, state, cause, person FROM run_states WHERE run_id = ? ORDER BY id"
    );
    query.bind(1, id);
    std::vector<lab::RunChange> changes;
    while (query.executeStep()) {
        changes.push_back({
            .run = query.getColumn(0).getInt64(),
            .at = query.getColumn(1).getInt64(),
            .state = lab::run_state_from_text(query.getColumn(2).getString()).value(),
            .cause = query.getColumn(3).getString(),
            .person = optional_time(query.getColumn(4)),
        });
    }
    return changes;
}

std::vector<lab::RunId> RunRepository::interrupt_unfinished(
    TimeNs now, const std::string& reason, const std::optional<std::string>& rig
) {
    Database::Transaction transaction(database_);
    std::vector<lab::RunId> open;
    SQLite::Statement query(
        transaction.connection(),
        "SELECT id FROM runs WHERE ended_ns IS NULL AND rig = coalesce(?, rig) ORDER BY id"
    );
    if (rig) query.bind(1, *rig);
    while (query.executeStep())
        open.push_back(query.getColumn(0).getInt64());
    for (const lab::RunId id : open) {
        if (auto changed = advance(id, {lab::RunEvent::interrupt, now, reason, {}}); !changed) {
            throw StoreError("run " + std::to_string(id) + ": " + to_text(changed.error()));
        }
    }
    transaction.commit();
    return open;
}

}  // namespace kinectlab::store
