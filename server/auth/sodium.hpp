#pragma once

namespace kinectlab::auth {

/// Everything that calls libsodium calls this first. Throws if the library cannot be used.
void need_sodium();

}  // namespace kinectlab::auth
