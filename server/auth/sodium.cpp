#include "server/auth/sodium.hpp"

#include <stdexcept>

#include <sodium.h>

namespace kinectlab::auth {

void need_sodium() {
    static const int state = sodium_init();
    if (state < 0) throw std::runtime_error("libsodium cannot be initialised");
}

}  // namespace kinectlab::auth
