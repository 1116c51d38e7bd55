#include "server/lab/rig.hpp"

#include <array>

namespace kinectlab::lab {

std::string_view to_text(RigState state) {
    constexpr std::array<std::string_view, 3> kStates{"idle", "busy", "offline"};
    return kStates.at(static_cast<std::size_t>(state));
}

}  // namespace kinectlab::lab
