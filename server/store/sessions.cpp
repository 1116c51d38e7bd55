#include "server/store/sessions.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>

namespace kinectlab::store {
namespace {

template <class... Values>
void run(Database& database, const char* sql, const Values&... values) {
    Database::Transaction transaction(database);
    SQLite::Statement statement(transaction.connection(), sql);
    SQLite::bind(statement, values...);
    statement.exec();
    transaction.commit();
}

}  // namespace

void SessionRepository::add(const Session& session) {
    run(database_,
        "INSERT INTO sessions (token_hash, csrf_token, user_id, created_ns, expires_ns) "
        "VALUES (?, ?, ?, ?, ?)",
        session.token_hash,
        session.csrf_token,
        session.user,
        session.created,
        session.expires);
}

std::optional<Session> SessionRepository::find(const std::string& token_hash, TimeNs now) {
    Database::Reader reader(database_);
    SQLite::Statement query(
        reader.connection(),
        "SELECT token_hash, csrf_token, user_id, created_ns, expires_ns FROM sessions "
        "WHERE token_hash = ? AND expires_ns > ?"
    );
    SQLite::bind(query, token_hash, now);
    if (!query.executeStep()) return std::nullopt;
    return Session{
        .token_hash = query.getColumn(0).getString(),
        .csrf_token = query.getColumn(1).getString(),
        .user = query.getColumn(2).getInt64(),
        .created = query.getColumn(3).getInt64(),
        .expires = query.getColumn(4).getInt64(),
    };
}

void SessionRepository::extend(const std::string& token_hash, TimeNs expires) {
    run(database_, "UPDATE sessions SET expires_ns = ? WHERE token_hash = ?", expires, token_hash);
}

void SessionRepository::remove(const std::string& token_hash) {
    run(database_, "DELETE FROM sessions WHERE token_hash = ?", token_hash);
}

void SessionRepository::remove_all_of(lab::UserId user) {
    run(database_, "DELETE FROM sessions WHERE user_id = ?", user);
}

void SessionRepository::remove_expired(TimeNs now) {
    run(database_, "DELETE FROM sessions WHERE expires_ns <= ?", now);
}

}  // namespace kinectlab::store
