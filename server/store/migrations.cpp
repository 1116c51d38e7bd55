#include "server/store/migrations.hpp"

#include <charconv>
#include <fstream>
#include <iterator>

#include <SQLiteCpp/SQLiteCpp.h>

#include "server/store/database.hpp"

namespace kinectlab::store {
namespace {

constexpr int kApplicationId = 0x4B4C4142;  // "KLAB", as `file` shows it

/// The number before the underscore; 0 if the name is not one of a script.
int number_of(const std::filesystem::path& script) {
    const std::string name = script.filename().string();
    int number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    const bool named = error == std::errc{} && end == name.data() + 4 && *end == '_';
    return named && script.extension() == ".sql" ? number : 0;
}

/// Scripts by number: the first is 1, no number is missing.
std::vector<std::filesystem::path> scripts_in(const std::filesystem::path& folder) {
    std::map<int, std::filesystem::path> by_number;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const int number = number_of(entry.path());
        if (number > 0 && !by_number.emplace(number, entry.path()).second) {
            throw StoreError(
                "two migrations have the number " + std::to_string(number) + " in " +
                folder.string()
            );
        }
    }
    if (by_number.empty()) throw StoreError("no migrations in " + folder.string());
    if (by_number.rbegin()->first != static_cast<int>(by_number.size())) {
        throw StoreError("a migration is missing in " + folder.string());
    }
    std::vector<std::filesystem::path> scripts;
    for (auto& [number, path] : by_number)
        scripts.push_back(std::move(path));
    return scripts;
}

std::string read(const std::filesystem::path& script) {
    std::ifstream file(script, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!file || text.empty()) throw StoreError("cannot read the migration " + script.string());
    return text;
}

void check_ours(SQLite::Database& connection, int version, int newest) {
    const int application = connection.execAndGet("PRAGMA application_id").getInt();
    const int tables = connection.execAndGet("SELECT count(*) FROM sqlite_schema").getInt();
    if (tables > 0 && application != kApplicationId) {
        throw StoreError(connection.getFilename() + " is not a database of this program");
    }
    if (version > newest) {
        throw StoreError(
            connection.getFilename() + " was written by a newer version of this program (schema " +
            std::to_string(version) + ", this one knows " + std::to_string(newest) +
            "); start that version, or restore a backup"
        );
    }
}

}  // namespace

void migrate(SQLite::Database& connection, const std::filesystem::path& folder) {
    const auto scripts = scripts_in(folder);
    const int newest = static_cast<int>(scripts.size());

    // IMMEDIATE: of two programs that start at once the second waits, then finds nothing to do.
    SQLite::Transaction transaction(connection, SQLite::TransactionBehavior::IMMEDIATE);
    const int version = connection.execAndGet("PRAGMA user_version").getInt();
    check_ours(connection, version, newest);
    for (int i = version; i < newest; ++i) {
        try {
            connection.exec(read(scripts[static_cast<std::size_t>(i)]));
        } catch (const SQLite::Exception& error) {
            throw StoreError(
                "migration " + scripts[static_cast<std::size_t>(i)].filename().string() +
                " failed: " + error.what()
            );
        }
    }
    connection.exec("PRAGMA application_id = " + std::to_string(kApplicationId));
    connection.exec("PRAGMA user_version = " + std::to_string(newest));
    transaction.commit();
}

}  // namespace kinectlab::store
