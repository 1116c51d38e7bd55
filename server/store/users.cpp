#include "server/store/users.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>

namespace kinectlab::store {
namespace {

constexpr const char* kColumns =
    "SELECT id, username, display_name, role, must_change_password, created_ns, password_hash "
    "FROM users ";

lab::User read_user(SQLite::Statement& row) {
    return {
        .id = row.getColumn(0).getInt64(),
        .username = row.getColumn(1).getString(),
        .display_name = row.getColumn(2).getString(),
        .role = lab::role_from_text(row.getColumn(3).getString()).value(),
        .must_change_password = row.getColumn(4).getInt() != 0,
        .created = row.getColumn(5).getInt64(),
    };
}

template <class Key>
std::optional<Credentials> find_by(Database& database, const char* condition, const Key& key) {
    Database::Reader reader(database);
    SQLite::Statement query(reader.connection(), std::string(kColumns) + condition);
    query.bind(1, key);
    if (!query.executeStep()) return std::nullopt;
    return Credentials{read_user(query), query.getColumn(6).getString()};
}

}  // namespace

Result<lab::User> UserRepository::add(const NewUser& user, TimeNs now) {
    Database::Transaction transaction(database_);
    if (credentials(user.username)) {
        return fail(
            ErrorCode::conflict, "username", "\"" + user.username + "\" is taken", "choose another"
        );
    }
    SQLite::Statement insert(
        transaction.connection(),
        "INSERT INTO users (username, display_name, role, password_hash, must_change_password, "
        "created_ns) VALUES (?, ?, ?, ?, ?, ?)"
    );
    SQLite::bind(
        insert,
        user.username,
        user.display_name,
        std::string(to_text(user.role)),
        user.password_hash,
        user.must_change_password ? 1 : 0,
        now
    );
    insert.exec();
    const lab::UserId id = transaction.connection().getLastInsertRowid();
    transaction.commit();
    return lab::User{
        id, user.username, user.display_name, user.role, user.must_change_password, now};
}

std::optional<lab::User> UserRepository::find(lab::UserId id) {
    auto found = find_by(database_, "WHERE id = ?", id);
    if (!found) return std::nullopt;
    return std::move(found->user);
}

std::optional<Credentials> UserRepository::credentials(const std::string& username) {
    return find_by(database_, "WHERE username = ?", username);
}

std::optional<Credentials> UserRepository::credentials(lab::UserId id) {
    return find_by(database_, "WHERE id = ?", id);
}

void UserRepository::set_password(
    lab::UserId id, const std::string& password_hash, bool must_change
) {
    Database::Transaction transaction(database_);
    SQLite::Statement update(
        transaction.connection(),
        "UPDATE users SET password_hash = ?, must_change_password = ? WHERE id = ?"
    );
    SQLite::bind(update, password_hash, must_change ? 1 : 0, id);
    update.exec();
    SQLite::Statement end(transaction.connection(), "DELETE FROM sessions WHERE user_id = ?");
    end.bind(1, id);
    end.exec();
    transaction.commit();
}

std::vector<lab::User> UserRepository::all() {
    Database::Reader reader(database_);
    SQLite::Statement query(
        reader.connection(), std::string(kColumns) + "ORDER BY username COLLATE NOCASE"
    );
    std::vector<lab::User> users;
    while (query.executeStep())
        users.push_back(read_user(query));
    return users;
}

}  // namespace kinectlab::store
