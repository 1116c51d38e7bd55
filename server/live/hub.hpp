#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/bus/bus.hpp"
#include "server/live/jpeg.hpp"
#include "server/live/viewer.hpp"

namespace kinectlab::live {

/// How domain values look as JSON is decided where all wire types are; the hub only asks.
struct Encoders {
    std::function<std::string(const lab::RigStatus&)> rig;
    std::function<std::string(const lab::Run&)> run;
};

/// Where a rig's status comes from for a viewer who arrives before it ever changed.
using FindRig = std::function<std::optional<lab::RigStatus>(const std::string& rig)>;

/// Events in, messages out: each is encoded once and the same buffer goes to every viewer of its
/// rig; pictures are encoded on a thread of their own and only while somebody watches.
class Hub {
public:
    /// Listens from here on; the references and functions must outlive it.
    Hub(bus::Bus& bus, Encoders encoders, FindRig find_rig, JpegCache& jpegs);
    ~Hub();
    Hub(const Hub&) = delete;
    Hub& operator=(const Hub&) = delete;

    /// One viewer's place; the destructor gives it back, after which `wake` is not called any more.
    class Place {
    public:
        Place(Hub& hub, std::string rig, std::shared_ptr<Viewer> viewer);
        ~Place();
        Place(const Place&) = delete;
        Place& operator=(const Place&) = delete;
        [[nodiscard]] Viewer& viewer() const { return *viewer_; }

    private:
        Hub& hub_;
        std::string rig_;
        std::shared_ptr<Viewer> viewer_;
    };

    /// The viewer's first message is the hello, with the path of the run so far; what follows joins
    /// it without gap or repetition.
    [[nodiscard]] std::unique_ptr<Place> watch(const std::string& rig);

    [[nodiscard]] std::size_t viewers(const std::string& rig) const;

    /// Hands on what was published so far and listens no more.
    void finish();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab::live
