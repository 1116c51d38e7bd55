#pragma once

#include "server/store/bookings.hpp"
#include "server/store/database.hpp"
#include "server/store/definitions.hpp"
#include "server/store/poses.hpp"
#include "server/store/results.hpp"
#include "server/store/runs.hpp"
#include "server/store/sessions.hpp"
#include "server/store/users.hpp"

namespace kinectlab::store {

/// Everything that is kept, in one file. Thread-safe.
struct Store {
    /// Throws StoreError.
    Store(const std::filesystem::path& file, const std::filesystem::path& migrations)
        : database(file, migrations) {}

    Database database;
    UserRepository users{database};
    SessionRepository sessions{database};
    BookingRepository bookings{database};
    RunRepository runs{database};
    PoseRepository poses{database};
    ResultRepository results{database};
    DefinitionRepository definitions{database};
};

}  // namespace kinectlab::store
