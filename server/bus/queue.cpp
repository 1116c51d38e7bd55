#include "server/bus/queue.hpp"

#include <algorithm>

namespace kinectlab::bus {
namespace {

template <class Kind>
bool is(const Delivery& delivery) {
    return std::holds_alternative<Kind>(*delivery.event);
}

}  // namespace

void Queue::push(const std::shared_ptr<const Event>& event) {
    const std::lock_guard lock(mutex_);
    if (closed_ || (!settings_.rig.empty() && rig_of(*event) != settings_.rig)) return;
    const bool was_empty = waiting_.empty();
    Delivery delivery{event, 0};
    if (is<PoseMeasured>(delivery)) {
        make_room<PoseMeasured>(settings_.poses, delivery);
    } else if (is<PictureTaken>(delivery)) {
        make_room<PictureTaken>(settings_.pictures, delivery);
    } else if (const auto* status = std::get_if<RigChanged>(event.get())) {
        forget_older_status(*status);
    }
    waiting_.push_back(std::move(delivery));
    arrived_.notify_one();
    // Under the lock: once close() has returned, nobody is woken any more.
    if (was_empty && settings_.wake) settings_.wake();
}

/// Drops the oldest of a kind where there are too many; the next of the kind tells of the loss.
template <class Kind>
void Queue::make_room(std::size_t limit, Delivery& newest) {
    const auto count = std::count_if(waiting_.begin(), waiting_.end(), is<Kind>);
    if (static_cast<std::size_t>(count) < std::max<std::size_t>(limit, 1)) return;
    const auto oldest = std::find_if(waiting_.begin(), waiting_.end(), is<Kind>);
    const auto heir = std::find_if(std::next(oldest), waiting_.end(), is<Kind>);
    (heir == waiting_.end() ? newest : *heir).dropped += oldest->dropped + 1;
    waiting_.erase(oldest);
    ++dropped_;
}

void Queue::forget_older_status(const RigChanged& newest) {
    std::erase_if(waiting_, [&](const Delivery& delivery) {
        const auto* older = std::get_if<RigChanged>(delivery.event.get());
        return older != nullptr && older->rig.id == newest.rig.id;
    });
}

std::optional<Delivery> Queue::pop(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    const auto something = [&] {
        return !waiting_.empty();
    };
    if (!arrived_.wait_for(lock, timeout, something)) return std::nullopt;
    Delivery first = std::move(waiting_.front());
    waiting_.pop_front();
    return first;
}

std::uint64_t Queue::dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
}

void Queue::close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    waiting_.clear();
}

}  // namespace kinectlab::bus
