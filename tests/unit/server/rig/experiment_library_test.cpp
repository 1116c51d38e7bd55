#include "server/rig/experiment_library.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/experiments/share_dir.hpp"
#include "tests/unit/server/temporary_store.hpp"

namespace kinectlab::rig {
namespace {

using test::kNoon;
using test::TemporaryStore;

class ExperimentLibraryTest : public testing::Test {
protected:
    ExperimentLibraryTest()
        : library_({pendulum("pendulum")}, store_->definitions),
          ada_(store_.add_user("ada", lab::Role::instructor)),
          bob_(store_.add_user("bob", lab::Role::instructor)),
          cleo_(store_.add_user("cleo")) {}

    static experiments::Definition pendulum(const std::string& id, const std::string& title = "P") {
        auto definition =
            experiments::read_definition(nlohmann::json::parse(test::pendulum_json())).value();
        definition.id = id;
        definition.title = title;
        return definition;
    }
    std::vector<std::string> seen_by(const lab::User& user) {
        std::vector<std::string> ids;
        for (const auto& entry : library_.list(user))
            ids.push_back(
                entry.definition.id + " " + std::string(to_text(entry.state)) + " " +
                std::to_string(entry.version.value_or(0))
            );
        return ids;
    }

    TemporaryStore store_;
    ExperimentLibrary library_;
    lab::User ada_, bob_, cleo_;
};

TEST_F(ExperimentLibraryTest, ADraftIsItsOwnersUntilItIsPublished) {
    ASSERT_TRUE(library_.save(ada_, pendulum("mine"), kNoon));
    EXPECT_EQ(seen_by(ada_).size(), 2U);
    EXPECT_EQ(seen_by(bob_).size(), 1U);
    EXPECT_FALSE(library_.offered("mine"));
    ASSERT_TRUE(library_.publish(ada_, "mine", kNoon));
    EXPECT_EQ(
        seen_by(cleo_), (std::vector<std::string>{"pendulum built-in 0", "mine published 1"})
    );
    EXPECT_TRUE(library_.offered("mine"));
}

TEST_F(ExperimentLibraryTest, APublishedVersionStaysWhileTheNextIsWritten) {
    ASSERT_TRUE(library_.save(ada_, pendulum("mine", "first"), kNoon));
    ASSERT_TRUE(library_.publish(ada_, "mine", kNoon));
    const auto second = library_.save(ada_, pendulum("mine", "second"), kNoon);
    ASSERT_TRUE(second);
    EXPECT_EQ(second->version, 2);
    EXPECT_EQ(library_.offered("mine")->title, "first");
    ASSERT_TRUE(library_.publish(ada_, "mine", kNoon));
    EXPECT_EQ(library_.offered("mine")->title, "second");
    EXPECT_EQ(store_->definitions.all("mine").size(), 2U);
    EXPECT_EQ(seen_by(cleo_).size(), 2U);
}

TEST_F(ExperimentLibraryTest, NobodyTouchesAnothersOrTheProgramsOwn) {
    ASSERT_TRUE(library_.save(ada_, pendulum("mine"), kNoon));
    EXPECT_EQ(library_.save(bob_, pendulum("mine"), kNoon).error().code, ErrorCode::forbidden);
    EXPECT_EQ(library_.publish(bob_, "mine", kNoon).error().code, ErrorCode::forbidden);
    EXPECT_EQ(library_.retire(bob_, "mine", kNoon).error().code, ErrorCode::forbidden);
    EXPECT_EQ(library_.save(cleo_, pendulum("hers"), kNoon).error().code, ErrorCode::forbidden);
    EXPECT_EQ(library_.save(ada_, pendulum("pendulum"), kNoon).error().code, ErrorCode::conflict);
    EXPECT_EQ(
        library_.save(ada_, pendulum("../x"), kNoon).error().code, ErrorCode::invalid_argument
    );
    EXPECT_EQ(library_.publish(ada_, "none", kNoon).error().code, ErrorCode::not_found);
}

TEST_F(ExperimentLibraryTest, WhatIsRetiredIsOfferedNoLonger) {
    ASSERT_TRUE(library_.save(ada_, pendulum("mine"), kNoon));
    ASSERT_TRUE(library_.publish(ada_, "mine", kNoon));
    EXPECT_EQ(library_.publish(ada_, "mine", kNoon).error().code, ErrorCode::conflict);
    ASSERT_TRUE(library_.retire(ada_, "mine", kNoon));
    EXPECT_FALSE(library_.offered("mine"));
    EXPECT_EQ(seen_by(cleo_).size(), 1U);
    EXPECT_EQ(library_.retire(ada_, "mine", kNoon).error().code, ErrorCode::conflict);
}

}  // namespace
}  // namespace kinectlab::rig
