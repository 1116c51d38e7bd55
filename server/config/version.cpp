#include "server/config/version.hpp"

namespace kinectlab::config {

const char* version() {
    return KINECTLAB_VERSION;
}

}  // namespace kinectlab::config
