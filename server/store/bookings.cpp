#include "server/store/bookings.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>

namespace kinectlab::store {
namespace {

constexpr const char* kColumns =
    "SELECT b.id, b.user_id, u.display_name, b.experiment, b.rig, b.start_ns, b.end_ns, "
    "b.created_ns FROM bookings b JOIN users u ON u.id = b.user_id WHERE ";

/// No slot is longer than a day (a CHECK of the table), so what touches a time starts no earlier.
constexpr const char* kOnRig =
    "b.cancelled_ns IS NULL AND b.rig = ? AND b.start_ns < ? AND b.start_ns > ? AND b.end_ns > ? "
    "ORDER BY b.start_ns";
constexpr TimeNs kLongestSlot = 86400 * kNsPerSecond;

template <class... Values>
std::vector<lab::Booking> select(
    SQLite::Database& connection, const char* condition, const Values&... values
) {
    SQLite::Statement query(connection, std::string(kColumns) + condition);
    SQLite::bind(query, values...);
    std::vector<lab::Booking> bookings;
    while (query.executeStep()) {
        bookings.push_back({
            .id = query.getColumn(0).getInt64(),
            .user = query.getColumn(1).getInt64(),
            .user_name = query.getColumn(2).getString(),
            .experiment = query.getColumn(3).getString(),
            .slot =
                {query.getColumn(4).getString(),
                 query.getColumn(5).getInt64(),
                 query.getColumn(6).getInt64()},
            .created = query.getColumn(7).getInt64(),
        });
    }
    return bookings;
}

std::vector<lab::Booking> select_on_rig(
    SQLite::Database& connection, const std::string& rig, TimeNs from, TimeNs to
) {
    return select(connection, kOnRig, rig, to, from - kLongestSlot, from);
}

std::vector<lab::Booking> select_of_user(
    SQLite::Database& connection, lab::UserId user, TimeNs from
) {
    return select(
        connection,
        "b.cancelled_ns IS NULL AND b.user_id = ? AND b.end_ns > ? ORDER BY b.start_ns",
        user,
        from
    );
}

}  // namespace

Result<lab::Booking> BookingRepository::add(
    const lab::BookingRequest& request, TimeNs now, const lab::BookingRules& rules
) {
    Database::Transaction transaction(database_);
    auto& connection = transaction.connection();
    const lab::Slot& slot = request.slot;
    auto existing = select_on_rig(connection, slot.rig, slot.start, slot.end);
    for (auto& own : select_of_user(connection, request.user, now)) {
        existing.push_back(std::move(own));
    }
    if (auto allowed = lab::check_booking(request, existing, now, rules); !allowed) {
        return tl::unexpected(allowed.error());
    }
    SQLite::Statement insert(
        connection,
        "INSERT INTO bookings (rig, experiment, user_id, start_ns, end_ns, created_ns) "
        "VALUES (?, ?, ?, ?, ?, ?)"
    );
    SQLite::bind(insert, slot.rig, request.experiment, request.user, slot.start, slot.end, now);
    insert.exec();
    auto booking = select(connection, "b.id = ?", connection.getLastInsertRowid()).at(0);
    transaction.commit();
    return booking;
}

std::vector<lab::Slot> BookingRepository::alternatives(
    const lab::Slot& wanted, const std::vector<std::string>& rigs, TimeNs now, std::size_t count
) {
    const lab::BookingRules rules;
    std::vector<lab::Booking> existing;
    Database::Reader reader(database_);
    for (const auto& rig : rigs) {
        // The block that has begun is still on offer, so bookings that just ended matter too.
        const TimeNs from = now - rules.granularity;
        auto on_rig = select_on_rig(reader.connection(), rig, from, now + rules.horizon);
        existing.insert(existing.end(), on_rig.begin(), on_rig.end());
    }
    return lab::alternatives(wanted, rigs, existing, now, count, rules);
}

std::optional<lab::Booking> BookingRepository::find(lab::BookingId id) {
    Database::Reader reader(database_);
    auto found = select(reader.connection(), "b.id = ?", id);
    if (found.empty()) return std::nullopt;
    return std::move(found.front());
}

std::vector<lab::Booking> BookingRepository::on_rig(
    const std::string& rig, TimeNs from, TimeNs to
) {
    Database::Reader reader(database_);
    return select_on_rig(reader.connection(), rig, from, to);
}

std::vector<lab::Booking> BookingRepository::of_user(lab::UserId user, TimeNs from) {
    Database::Reader reader(database_);
    return select_of_user(reader.connection(), user, from);
}

std::optional<lab::Booking> BookingRepository::at(const std::string& rig, TimeNs now) {
    Database::Reader reader(database_);
    auto found = select_on_rig(reader.connection(), rig, now, now + 1);
    if (found.empty()) return std::nullopt;
    return std::move(found.front());
}

Result<void> BookingRepository::cancel(lab::BookingId id, TimeNs now) {
    Database::Transaction transaction(database_);
    auto& connection = transaction.connection();
    SQLite::Statement running(
        connection, "SELECT 1 FROM runs WHERE booking_id = ? AND ended_ns IS NULL"
    );
    running.bind(1, id);
    if (running.executeStep()) {
        return fail(
            ErrorCode::conflict, "booking", "its run is under way", "stop or abort the run first"
        );
    }
    SQLite::Statement update(
        connection, "UPDATE bookings SET cancelled_ns = ? WHERE id = ? AND cancelled_ns IS NULL"
    );
    SQLite::bind(update, now, id);
    if (update.exec() == 0) {
        return fail(
            ErrorCode::not_found,
            "booking",
            "there is no booking " + std::to_string(id),
            "it may have been given up already"
        );
    }
    transaction.commit();
    return {};
}

}  // namespace kinectlab::store
