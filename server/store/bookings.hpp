#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/lab/booking.hpp"
#include "server/store/database.hpp"

namespace kinectlab::store {

/// Slots on rigs. Cancelled bookings are kept and not returned, except by find().
class BookingRepository {
public:
    explicit BookingRepository(Database& database) : database_(database) {}

    /// Checks lab::check_booking and inserts, in one transaction: of two who race one gets the
    /// slot. Errors as check_booking.
    [[nodiscard]] Result<lab::Booking> add(
        const lab::BookingRequest& request, TimeNs now, const lab::BookingRules& rules = {}
    );
    /// The nearest free slots on any of `rigs`, for a person whose wish was in conflict.
    [[nodiscard]] std::vector<lab::Slot> alternatives(
        const lab::Slot& wanted,
        const std::vector<std::string>& rigs,
        TimeNs now,
        std::size_t count = 3
    );
    [[nodiscard]] std::optional<lab::Booking> find(lab::BookingId id);
    /// The bookings that touch [from, to), in order of start.
    [[nodiscard]] std::vector<lab::Booking> on_rig(const std::string& rig, TimeNs from, TimeNs to);
    /// The bookings of this person that end after `from`, in order of start.
    [[nodiscard]] std::vector<lab::Booking> of_user(lab::UserId user, TimeNs from);
    /// Who has the rig at this moment.
    [[nodiscard]] std::optional<lab::Booking> at(const std::string& rig, TimeNs now);
    /// Error not_found; conflict while a run of this booking is under way.
    [[nodiscard]] Result<void> cancel(lab::BookingId id, TimeNs now);

private:
    Database& database_;
};

}  // namespace kinectlab::store
