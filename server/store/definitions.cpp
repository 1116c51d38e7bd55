#include "server/store/definitions.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>

namespace kinectlab::store {
namespace {

std::optional<TimeNs> time_or_none(const SQLite::Column& column) {
    return column.isNull() ? std::nullopt : std::optional<TimeNs>(column.getInt64());
}

}  // namespace

std::vector<StoredDefinition> DefinitionRepository::all(const std::optional<std::string>& experiment
) {
    Database::Reader reader(database_);
    SQLite::Statement query(
        reader.connection(),
        "SELECT d.experiment, d.version, d.owner, u.display_name, d.definition, d.created_ns, "
        "d.published_ns, d.retired_ns FROM definitions d JOIN users u ON u.id = d.owner "
        "WHERE ?1 IS NULL OR d.experiment = ?1 ORDER BY d.experiment, d.version DESC"
    );
    if (experiment) query.bind(1, *experiment);
    std::vector<StoredDefinition> found;
    while (query.executeStep())
        found.push_back(
            {query.getColumn(0).getString(),
             query.getColumn(1).getInt(),
             query.getColumn(2).getInt64(),
             query.getColumn(3).getString(),
             query.getColumn(4).getString(),
             query.getColumn(5).getInt64(),
             time_or_none(query.getColumn(6)),
             time_or_none(query.getColumn(7))}
        );
    return found;
}

StoredDefinition DefinitionRepository::put_draft(
    const std::string& experiment, lab::UserId owner, const std::string& json, TimeNs now
) {
    {
        Database::Transaction transaction(database_);
        auto& connection = transaction.connection();
        SQLite::Statement change(
            connection,
            "UPDATE definitions SET definition = ?, created_ns = ? "
            "WHERE experiment = ? AND published_ns IS NULL"
        );
        SQLite::bind(change, json, now, experiment);
        if (change.exec() == 0) {
            SQLite::Statement insert(
                connection,
                "INSERT INTO definitions (experiment, version, owner, definition, created_ns) "
                "SELECT ?1, coalesce(max(version), 0) + 1, ?2, ?3, ?4 FROM definitions "
                "WHERE experiment = ?1"
            );
            SQLite::bind(insert, experiment, owner, json, now);
            insert.exec();
        }
        transaction.commit();
    }
    return all(experiment).front();
}

bool DefinitionRepository::publish(const std::string& experiment, TimeNs now) {
    Database::Transaction transaction(database_);
    SQLite::Statement change(
        transaction.connection(),
        "UPDATE definitions SET published_ns = ? WHERE experiment = ? AND published_ns IS NULL"
    );
    SQLite::bind(change, now, experiment);
    const bool done = change.exec() > 0;
    transaction.commit();
    return done;
}

bool DefinitionRepository::retire(const std::string& experiment, TimeNs now) {
    Database::Transaction transaction(database_);
    SQLite::Statement forget(
        transaction.connection(),
        "DELETE FROM definitions WHERE experiment = ? AND published_ns IS NULL"
    );
    forget.bind(1, experiment);
    int changed = forget.exec();
    SQLite::Statement change(
        transaction.connection(),
        "UPDATE definitions SET retired_ns = ? WHERE experiment = ? AND retired_ns IS NULL"
    );
    SQLite::bind(change, now, experiment);
    changed += change.exec();
    transaction.commit();
    return changed > 0;
}

}  // namespace kinectlab::store
