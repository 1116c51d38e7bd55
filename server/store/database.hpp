#pragma once

#include <filesystem>
#include <memory>
#include <stdexcept>

namespace SQLite {
class Database;
}

namespace kinectlab::store {

/// The file cannot be used: damaged, locked by another server, or written by a newer version.
class StoreError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The SQLite file of the laboratory: write-ahead log, foreign keys, full synchronisation, so that
/// what was acknowledged is on the disk. Opening brings an older file up to date. Thread-safe: one
/// connection writes and one reads, each for one thread at a time. Broken storage throws.
class Database {
public:
    /// `migrations` holds 0001_name.sql, 0002_… without gaps. Throws StoreError.
    Database(const std::filesystem::path& file, const std::filesystem::path& migrations);
    ~Database();
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    /// All or nothing; nested ones of the same thread join the outermost. Rolls back unless
    /// commit() was called; the outermost commit() returns when the data is on the disk.
    class Transaction {
    public:
        explicit Transaction(Database& database);
        ~Transaction();
        Transaction(const Transaction&) = delete;
        Transaction& operator=(const Transaction&) = delete;

        void commit();
        [[nodiscard]] SQLite::Database& connection();

    private:
        Database& database_;
        bool committed_ = false;
    };

    /// The reading connection, locked for this thread as long as it lives. Inside a transaction of
    /// this thread it is the writing one, so that a transaction sees its own changes.
    class Reader {
    public:
        explicit Reader(Database& database);
        ~Reader();
        Reader(const Reader&) = delete;
        Reader& operator=(const Reader&) = delete;

        [[nodiscard]] SQLite::Database& connection();

    private:
        Database& database_;
        bool in_transaction_;
    };

    /// The number of the newest migration in the file.
    [[nodiscard]] int version() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab::store
