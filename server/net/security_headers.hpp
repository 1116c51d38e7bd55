#pragma once

#include <array>

namespace kinectlab::net {

struct ConstantHeader {
    const char* name;
    const char* value;
};

/// Every answer carries these. Nothing inline, nothing from elsewhere, nobody frames us.
constexpr std::array<ConstantHeader, 6> kSecurityHeaders{{
    {"Content-Security-Policy",
     "default-src 'self'; img-src 'self' data: blob:; font-src 'self' data:; object-src 'none'; "
     "base-uri 'none'; form-action 'self'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Permissions-Policy", "camera=(), microphone=(), geolocation=()"},
}};

}  // namespace kinectlab::net
