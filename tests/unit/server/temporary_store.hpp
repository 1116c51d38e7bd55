#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "server/store/store.hpp"

namespace kinectlab::test {

/// A folder that is gone when the test is over.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string pattern = std::filesystem::temp_directory_path() / "kinectlab-test-XXXXXX";
        if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
        path_ = pattern;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

inline std::filesystem::path migrations() {
    return std::filesystem::path(KINECTLAB_SOURCE_DIR) / "migrations";
}

/// The definition that a pendulum's runs are made with.
inline std::string pendulum_json() {
    std::ifstream file(std::string(KINECTLAB_SOURCE_DIR) + "/server/experiments/pendulum.json");
    return {std::istreambuf_iterator<char>(file), {}};
}

constexpr TimeNs kMinute = 60 * kNsPerSecond;
constexpr TimeNs kNoon = 1'795'348'800 * kNsPerSecond;  ///< 2026-11-22T12:00:00Z

/// A store in a temporary folder.
class TemporaryStore {
public:
    TemporaryStore() : store_(open()) {}

    [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "lab.sqlite"; }
    [[nodiscard]] std::unique_ptr<store::Store> open() const {
        return std::make_unique<store::Store>(file(), migrations());
    }
    store::Store* operator->() { return store_.get(); }
    store::Store& operator*() { return *store_; }

    lab::User add_user(const std::string& name, lab::Role role = lab::Role::student) {
        return store_->users
            .add({name, "Display " + name, role, "$argon2id$not-a-real-hash", false}, kNoon)
            .value();
    }
    lab::Booking add_booking(
        const lab::User& user, TimeNs start, TimeNs end, const std::string& rig = "rig-1"
    ) {
        return store_->bookings.add({user.id, user.role, "pendulum", {rig, start, end}}, kNoon)
            .value();
    }
    lab::Run add_run(const lab::Booking& booking, TimeNs now = kNoon) {
        return store_->runs.add(run_for(booking, now)).value();
    }
    static lab::Run run_for(const lab::Booking& booking, TimeNs now = kNoon) {
        return {
            .rig = booking.slot.rig,
            .experiment = "pendulum",
            .user = booking.user,
            .booking = booking.id,
            .parameters = {{"length_m", 1.0}},
            .definition_json = pendulum_json(),
            .duration_s = 10.0,
            .created = now,
            .release_until = now + 5 * kMinute,
        };
    }

private:
    TemporaryFolder folder_;
    std::unique_ptr<store::Store> store_;
};

}  // namespace kinectlab::test
