#include "server/store/database.hpp"

#include <fstream>
#include <thread>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "tests/unit/server/temporary_store.hpp"

namespace kinectlab::store {
namespace {

using test::TemporaryFolder;

class DatabaseTest : public testing::Test {
protected:
    [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "lab.sqlite"; }
    [[nodiscard]] std::filesystem::path scripts() const { return folder_.path() / "migrations"; }

    void write_script(const std::string& name, const std::string& sql) const {
        std::filesystem::create_directories(scripts());
        std::ofstream(scripts() / name) << sql;
    }

    std::string refusal() const {
        try {
            const Database database(file(), scripts());
            return "";
        } catch (const StoreError& error) {
            return error.what();
        }
    }

    TemporaryFolder folder_;
};

TEST_F(DatabaseTest, OpensWithTheSettingsThatKeepWhatWasAcknowledged) {
    Database database(file(), test::migrations());
    Database::Transaction transaction(database);
    auto& connection = transaction.connection();
    EXPECT_EQ(connection.execAndGet("PRAGMA journal_mode").getString(), "wal");
    EXPECT_EQ(connection.execAndGet("PRAGMA foreign_keys").getInt(), 1);
    EXPECT_EQ(connection.execAndGet("PRAGMA synchronous").getInt(), 2);
    EXPECT_EQ(database.version(), 3);
    const auto mode = std::filesystem::status(file()).permissions();
    EXPECT_EQ(mode & std::filesystem::perms::others_all, std::filesystem::perms::none);
}

TEST_F(DatabaseTest, EveryTableIsStrict) {
    Database database(file(), test::migrations());
    Database::Reader reader(database);
    const auto loose = reader.connection().execAndGet(
        "SELECT count(*) FROM pragma_table_list WHERE schema = 'main' AND type = 'table' "
        "AND strict = 0 AND name NOT LIKE 'sqlite_%'"
    );
    EXPECT_EQ(loose.getInt(), 0);
}

TEST_F(DatabaseTest, MigratesAnOlderFileWithoutLoss) {
    write_script("0001_first.sql", "CREATE TABLE a (x INTEGER) STRICT; INSERT INTO a VALUES (1);");
    { const Database first(file(), scripts()); }
    write_script("0002_second.sql", "ALTER TABLE a ADD COLUMN y INTEGER;");
    Database second(file(), scripts());
    EXPECT_EQ(second.version(), 2);
    Database::Reader reader(second);
    EXPECT_EQ(reader.connection().execAndGet("SELECT x FROM a").getInt(), 1);
}

TEST_F(DatabaseTest, AFailingMigrationLeavesTheFileAsItWas) {
    write_script("0001_first.sql", "CREATE TABLE a (x INTEGER) STRICT;");
    { const Database first(file(), scripts()); }
    write_script("0002_second.sql", "CREATE TABLE b (x INTEGER) STRICT;");
    write_script("0003_broken.sql", "CREATE TABLE c (x INTEGER) STRICT; SELECT nonsense;");
    EXPECT_NE(refusal().find("0003_broken.sql"), std::string::npos);
    std::filesystem::remove(scripts() / "0003_broken.sql");
    std::filesystem::remove(scripts() / "0002_second.sql");
    EXPECT_EQ(refusal(), "");  // still at version 1, without the table b
}

TEST_F(DatabaseTest, RefusesAFileOfANewerProgram) {
    write_script("0001_first.sql", "CREATE TABLE a (x INTEGER) STRICT;");
    write_script("0002_second.sql", "CREATE TABLE b (x INTEGER) STRICT;");
    { const Database newer(file(), scripts()); }
    std::filesystem::remove(scripts() / "0002_second.sql");
    EXPECT_NE(refusal().find("newer version"), std::string::npos);
}

TEST_F(DatabaseTest, RefusesAFileOfSomebodyElseAndMissingScripts) {
    EXPECT_NE(refusal().find("no migrations"), std::string::npos);
    write_script("0001_first.sql", "CREATE TABLE a (x INTEGER) STRICT;");
    write_script("0003_third.sql", "CREATE TABLE c (x INTEGER) STRICT;");
    EXPECT_NE(refusal().find("missing"), std::string::npos);
    std::filesystem::remove(scripts() / "0003_third.sql");
    {
        SQLite::Database stranger(file().string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
        stranger.exec("CREATE TABLE theirs (x)");
    }
    EXPECT_NE(refusal().find("not a database of this program"), std::string::npos);
}

TEST_F(DatabaseTest, RefusesWhatIsNoDatabaseAtAll) {
    write_script("0001_first.sql", "CREATE TABLE a (x INTEGER) STRICT;");
    std::ofstream(file()) << std::string(5000, 'x');
    EXPECT_NE(refusal().find("lab.sqlite"), std::string::npos);
}

TEST_F(DatabaseTest, ATransactionGivenUpInsideAnotherTakesItDownToo) {
    write_script("0001_first.sql", "CREATE TABLE a (x INTEGER) STRICT;");
    Database database(file(), scripts());
    {
        Database::Transaction outer(database);
        outer.connection().exec("INSERT INTO a VALUES (1)");
        { Database::Transaction given_up(database); }
        EXPECT_THROW(outer.commit(), StoreError);
    }
    {
        Database::Transaction outer(database);
        outer.connection().exec("INSERT INTO a VALUES (2)");
        {
            Database::Transaction inner(database);
            inner.connection().exec("INSERT INTO a VALUES (3)");
            inner.commit();
        }
        Database::Reader reader(database);  // sees the transaction's own changes
        EXPECT_EQ(reader.connection().execAndGet("SELECT sum(x) FROM a").getInt(), 5);
        std::thread([&] {
            Database::Reader other(database);  // and nobody else does
            EXPECT_EQ(other.connection().execAndGet("SELECT count(*) FROM a").getInt(), 0);
        }).join();
        outer.commit();
    }
    Database::Reader reader(database);
    EXPECT_EQ(reader.connection().execAndGet("SELECT sum(x) FROM a").getInt(), 5);
}

}  // namespace
}  // namespace kinectlab::store
