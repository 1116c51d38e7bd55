#pragma once

#include <filesystem>

namespace SQLite {
class Database;
}

namespace kinectlab::store {

/// Runs the scripts in `folder` (0001_name.sql, 0002_…) that are newer than the file's
/// user_version, all in one transaction: a script that fails leaves the file as it was.
/// Throws StoreError where the folder has gaps, the file is newer than the folder, or the file is
/// an SQLite database of somebody else.
void migrate(SQLite::Database& connection, const std::filesystem::path& folder);

}  // namespace kinectlab::store
