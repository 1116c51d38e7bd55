#include "server/store/results.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>
#include <nlohmann/json.hpp>

namespace kinectlab::store {
namespace {

const std::string kWhole =
    "SELECT run_id, version, created_ns, result, fit, plots, warnings, person FROM results ";

StoredResult read(SQLite::Statement& row) {
    StoredResult result;
    result.run = row.getColumn(0).getInt64();
    result.version = row.getColumn(1).getInt();
    result.created = row.getColumn(2).getInt64();
    result.result_json = row.getColumn(3).getString();
    result.fit_json = row.getColumn(4).getString();
    result.plots_json = row.getColumn(5).getString();
    result.warnings = nlohmann::json::parse(row.getColumn(6).getString());
    if (!row.getColumn(7).isNull()) result.person = row.getColumn(7).getInt64();
    return result;
}

}  // namespace

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
        "INSERT INTO results (run_id, version, created_ns, result, fit, plots, warnings, person) "
        "VALUES (?, ?, ?, ?, ?, ?, ?, ?)"
    );
    SQLite::bind(
        insert,
        result.run,
        version,
        result.created,
        result.result_json,
        result.fit_json,
        result.plots_json,
        nlohmann::json(result.warnings).dump()
    );
    if (result.person) insert.bind(8, *result.person);
    insert.exec();
    transaction.commit();
    return version;
}

std::optional<StoredResult> ResultRepository::latest(lab::RunId run) {
    Database::Reader reader(database_);
    SQLite::Statement query(
        reader.connection(), kWhole + "WHERE run_id = ? ORDER BY version DESC LIMIT 1"
    );
    query.bind(1, run);
    return query.executeStep() ? std::optional(read(query)) : std::nullopt;
}

std::optional<StoredResult> ResultRepository::find(lab::RunId run, int version) {
    Database::Reader reader(database_);
    SQLite::Statement query(reader.connection(), kWhole + "WHERE run_id = ? AND version = ?");
    SQLite::bind(query, run, version);
    return query.executeStep() ? std::optional(read(query)) : std::nullopt;
}

std::vector<StoredResult> ResultRepository::versions(lab::RunId run) {
    Database::Reader reader(database_);
    SQLite::Statement query(
        reader.connection(),
        "SELECT run_id, version, created_ns, result, '', '', warnings, person FROM results "
        "WHERE run_id = ? ORDER BY version"
    );
    query.bind(1, run);
    std::vector<StoredResult> all;
    while (query.executeStep())
        all.push_back(read(query));
    return all;
}

}  // namespace kinectlab::store
