#include "server/bus/bus.hpp"

#include <mutex>
#include <vector>

#include "server/bus/queue.hpp"

namespace kinectlab::bus {

struct Bus::State {
    std::mutex mutex;
    std::vector<std::shared_ptr<Queue>> queues;
};

namespace {

class QueueSubscription final : public Subscription {
public:
    explicit QueueSubscription(std::shared_ptr<Queue> queue) : queue_(std::move(queue)) {}
    ~QueueSubscription() override { queue_->close(); }

    std::optional<Delivery> try_next() override { return queue_->pop({}); }
    std::optional<Delivery> next(std::chrono::milliseconds timeout) override {
        return queue_->pop(timeout);
    }
    std::uint64_t dropped() const override { return queue_->dropped(); }

private:
    std::shared_ptr<Queue> queue_;
};

}  // namespace

Bus::Bus() : state_(std::make_unique<State>()) {}

Bus::~Bus() = default;

void Bus::publish(Event event) {
    const auto shared = std::make_shared<const Event>(std::move(event));
    const std::lock_guard lock(state_->mutex);
    // A queue that only the bus still holds has lost its subscription.
    std::erase_if(state_->queues, [](const auto& queue) { return queue.use_count() == 1; });
    for (const auto& queue : state_->queues)
        queue->push(shared);
}

std::unique_ptr<Subscription> Bus::subscribe(SubscriptionSettings settings) {
    auto queue = std::make_shared<Queue>(std::move(settings));
    const std::lock_guard lock(state_->mutex);
    state_->queues.push_back(queue);
    return std::make_unique<QueueSubscription>(std::move(queue));
}

}  // namespace kinectlab::bus
