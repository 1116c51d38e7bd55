#pragma once

#include <string>
#include <string_view>

namespace kinectlab::auth {

/// 256 random bits as 43 characters that need no escaping anywhere (base64url).
[[nodiscard]] std::string make_token();

/// What is kept of a token: who reads the database cannot sign in with it. A token is random, so a
/// fast hash (BLAKE2b, 256 bits) is enough.
[[nodiscard]] std::string hash_token(std::string_view token);

/// In a time that does not depend on where they differ.
[[nodiscard]] bool same_secret(std::string_view a, std::string_view b);

}  // namespace kinectlab::auth
