#include "server/store/database.hpp"

#include <atomic>
#include <mutex>
#include <thread>

#include <SQLiteCpp/SQLiteCpp.h>

#include "server/store/migrations.hpp"

namespace kinectlab::store {
namespace {

constexpr int kBusyTimeoutMs = 10'000;

/// Creates the file readable by its owner only: it holds the hashes of passwords.
SQLite::Database open(const std::filesystem::path& file, int flags) {
    try {
        SQLite::Database connection(file.string(), flags, kBusyTimeoutMs);
        connection.exec("PRAGMA foreign_keys = ON");
        connection.exec("PRAGMA synchronous = FULL");
        return connection;
    } catch (const SQLite::Exception& error) {
        throw StoreError("cannot open the database " + file.string() + ": " + error.what());
    }
}

SQLite::Database open_writer(
    const std::filesystem::path& file, const std::filesystem::path& migrations
) {
    auto connection = open(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    try {
        std::filesystem::permissions(
            file, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write
        );
        connection.exec("PRAGMA journal_mode = WAL");
        migrate(connection, migrations);
    } catch (const SQLite::Exception& error) {
        throw StoreError("cannot prepare the database " + file.string() + ": " + error.what());
    }
    return connection;
}

}  // namespace

struct Database::State {
    State(const std::filesystem::path& file, const std::filesystem::path& migrations)
        : writer(open_writer(file, migrations)), reader(open(file, SQLite::OPEN_READONLY)) {}

    std::recursive_mutex writer_mutex;
    SQLite::Database writer;
    int depth = 0;        ///< of nested transactions; guarded by writer_mutex
    bool broken = false;  ///< an inner transaction was given up; guarded by writer_mutex
    std::atomic<std::thread::id> writing{};

    std::recursive_mutex reader_mutex;
    SQLite::Database reader;
};

Database::Database(const std::filesystem::path& file, const std::filesystem::path& migrations)
    : state_(std::make_unique<State>(file, migrations)) {}

Database::~Database() = default;

int Database::version() const {
    const std::lock_guard lock(state_->reader_mutex);
    return state_->reader.execAndGet("PRAGMA user_version").getInt();
}

Database::Transaction::Transaction(Database& database) : database_(database) {
    State& state = *database_.state_;
    std::unique_lock lock(state.writer_mutex);
    if (state.depth == 0) {
        // IMMEDIATE takes the write lock now: a transaction that read first cannot be refused
        // later.
        state.writer.exec("BEGIN IMMEDIATE");
        state.broken = false;
        state.writing = std::this_thread::get_id();
    }
    ++state.depth;
    lock.release();  // held until the destructor
}

Database::Transaction::~Transaction() {
    State& state = *database_.state_;
    if (!committed_) state.broken = true;
    if (--state.depth == 0) {
        if (state.broken) {
            try {
                state.writer.exec("ROLLBACK");
            } catch (const SQLite::Exception&) {
                // SQLite has rolled back by itself, e.g. where the disk is full.
            }
        }
        state.writing = std::thread::id{};
    }
    state.writer_mutex.unlock();
}

void Database::Transaction::commit() {
    State& state = *database_.state_;
    if (state.depth == 1) {
        if (state.broken) throw StoreError("a part of this transaction was given up");
        state.writer.exec("COMMIT");
    }
    committed_ = true;
}

SQLite::Database& Database::Transaction::connection() {
    return database_.state_->writer;
}

Database::Reader::Reader(Database& database)
    : database_(database),
      in_transaction_(database.state_->writing.load() == std::this_thread::get_id()) {
    if (!in_transaction_) database_.state_->reader_mutex.lock();
}

Database::Reader::~Reader() {
    if (!in_transaction_) database_.state_->reader_mutex.unlock();
}

SQLite::Database& Database::Reader::connection() {
    return in_transaction_ ? database_.state_->writer : database_.state_->reader;
}

}  // namespace kinectlab::store
