#include "server/bus/events.hpp"

namespace kinectlab::bus {
namespace {

struct RigOf {
    const std::string& operator()(const RigChanged& event) const { return event.rig.id; }
    const std::string& operator()(const RunChanged& event) const { return event.run.rig; }
    const std::string& operator()(const PoseMeasured& event) const { return event.rig; }
    const std::string& operator()(const PictureTaken& event) const { return event.rig; }
};

}  // namespace

const std::string& rig_of(const Event& event) {
    return std::visit(RigOf{}, event);
}

}  // namespace kinectlab::bus
