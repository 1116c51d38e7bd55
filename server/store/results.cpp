#include "server/store/results.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>
#include <nlohmann/json.hpp>

namespace kinectlab::store {

int ResultRepository::add(const StoredResult& result) {
    Database::Transaction transaction(database_);
    auto& connection = transaction.connection();
    SQLite::Statement newest(
        connection, "SELECT coalesce(max(version), 0) + 1 FROM results WHERE run_id = ?"
    );
    newest.bind(1, result.run);
    newest.executeStep();
    const int version = newest.getColumn(0).getInt();
    SQLite::Statement insert(
        connection,
        "INSERT INTO results (run_id, version, created_ns, result, fit, warnings) "
        "VALUES (?, ?, ?, ?, ?, ?)"
    );
    SQLite::bind(
        insert,
        result.run,
        version,
        result.created,
        result.result_json,
        result.fit_json,
        nlohmann::json(result.warnings).dump()
    );
    insert.exec();
    transaction.commit();
    return version;
}

std::optional<StoredResult> ResultRepository::latest(lab::RunId run) {
    Database::Reader reader(database_);
    SQLite::Statement query(
        reader.connection(),
        "SELECT version, created_ns, result, fit, warnings FROM results WHERE run_id = ? "
        "ORDER BY version DESC LIMIT 1"
    );
    query.bind(1, run);
    if (!query.executeStep()) return std::nullopt;
    return StoredResult{
        .run = run,
        .version = query.getColumn(0).getInt(),
        .created = query.getColumn(1).getInt64(),
        .result_json = query.getColumn(2).getString(),
        .fit_json = query.getColumn(3).getString(),
        .warnings = nlohmann::json::parse(query.getColumn(4).getString()),
    };
}

}  // namespace kinectlab::store
