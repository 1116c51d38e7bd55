#include "server/live/hub.hpp"

#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

#include "server/live/channel.hpp"

namespace kinectlab::live {
namespace {

TimeNs now_ns() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

template <class... Ts>
struct Overloaded : Ts... {
    using Ts::operator()...;
};

}  // namespace

struct Hub::State {
    Encoders encoders;
    FindRig find_rig;
    JpegCache& jpegs;
    std::unique_ptr<bus::Subscription> events;

    mutable std::mutex mutex;  ///< channels
    std::map<std::string, Channel> channels;

    std::mutex picture_mutex;  ///< the newest picture of each rig that waits to be encoded
    std::condition_variable picture_waits;
    std::map<std::string, bus::PictureTaken> pictures;

    std::atomic<bool> over{false};
    std::thread listener;
    std::thread painter;

    void listen();
    void paint();
    void handle(const bus::Event& event);
    [[nodiscard]] std::size_t viewers(const std::string& rig) const;
};

std::size_t Hub::State::viewers(const std::string& rig) const {
    const std::lock_guard lock(mutex);
    const auto found = channels.find(rig);
    return found == channels.end() ? 0 : found->second.viewers();
}

void Hub::State::handle(const bus::Event& event) {
    if (const auto* picture = std::get_if<bus::PictureTaken>(&event)) {
        if (viewers(picture->rig) == 0) return;
        {
            const std::lock_guard lock(picture_mutex);
            pictures[picture->rig] = *picture;
        }
        picture_waits.notify_one();
        return;
    }
    const std::lock_guard lock(mutex);
    Channel& channel = channels[bus::rig_of(event)];
    std::visit(
        Overloaded{
            [&](const bus::RigChanged& change) { channel.rig_changed(change.rig, encoders); },
            [&](const bus::RunChanged& change) { channel.run_changed(change.run, encoders); },
            [&](const bus::PoseMeasured& pose) { channel.pose_measured(pose, now_ns()); },
            [](const bus::PictureTaken&) {
            }},
        event
    );
}

void Hub::State::listen() {
    while (true) {
        const bool last = over;
        const auto delivery = events->next(std::chrono::milliseconds(last ? 0 : 200));
        if (delivery) handle(*delivery->event);
        if (!delivery && last) return;
    }
}

/// A picture takes milliseconds to encode: poses do not wait for that.
void Hub::State::paint() {
    while (true) {
        std::map<std::string, bus::PictureTaken> batch;
        {
            std::unique_lock lock(picture_mutex);
            picture_waits.wait(lock, [this] { return over || !pictures.empty(); });
            if (over) return;
            batch.swap(pictures);
        }
        for (const auto& [rig, picture] : batch) {
            const auto packet = jpegs.packet(picture);
            const std::lock_guard lock(mutex);
            channels[rig].picture_taken(packet);
        }
    }
}

Hub::Hub(bus::Bus& bus, Encoders encoders, FindRig find_rig, JpegCache& jpegs)
    : state_(new State{std::move(encoders), std::move(find_rig), jpegs}) {
    state_->events = bus.subscribe({});
    state_->listener = std::thread([state = state_.get()] { state->listen(); });
    state_->painter = std::thread([state = state_.get()] { state->paint(); });
}

Hub::~Hub() {
    finish();
}

void Hub::finish() {
    {
        const std::lock_guard lock(state_->picture_mutex);
        state_->over = true;
    }
    state_->picture_waits.notify_all();
    if (state_->listener.joinable()) state_->listener.join();
    if (state_->painter.joinable()) state_->painter.join();
}

Hub::Place::Place(Hub& hub, std::string rig, std::shared_ptr<Viewer> viewer)
    : hub_(hub), rig_(std::move(rig)), viewer_(std::move(viewer)) {}

Hub::Place::~Place() {
    viewer_->on_wake({});
    const std::lock_guard lock(hub_.state_->mutex);
    hub_.state_->channels[rig_].remove(viewer_);
}

std::unique_ptr<Hub::Place> Hub::watch(const std::string& rig) {
    auto viewer = std::make_shared<Viewer>();
    const auto status = state_->find_rig(rig);
    const std::lock_guard lock(state_->mutex);
    state_->channels[rig].add(viewer, status, state_->encoders, now_ns());
    return std::make_unique<Place>(*this, rig, std::move(viewer));
}

std::size_t Hub::viewers(const std::string& rig) const {
    return state_->viewers(rig);
}

}  // namespace kinectlab::live
