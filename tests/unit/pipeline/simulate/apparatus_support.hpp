#pragma once

#include <gtest/gtest.h>

#include "pipeline/simulate/apparatus.hpp"

namespace kinectlab::simulate {

inline std::unique_ptr<Apparatus> made(const std::string& name, const ParameterMap& given = {}) {
    auto apparatus = make_apparatus({name, given});
    EXPECT_TRUE(apparatus) << to_text(apparatus.error());
    return std::move(*apparatus);
}

/// Brought to its start and just let go; t_s() is the time of the release.
inline std::unique_ptr<Apparatus> released(
    const std::string& name, const ParameterMap& given = {}, double value = 0.0
) {
    auto apparatus = made(name, given);
    EXPECT_TRUE(apparatus->apply({Action::displace, value}));
    apparatus->advance_to(3.0);
    EXPECT_EQ(apparatus->motion(), Motion::held);
    EXPECT_TRUE(apparatus->apply({Action::release}));
    EXPECT_EQ(apparatus->motion(), Motion::free);
    return apparatus;
}

/// A body so long after the release of `apparatus`.
inline Body after(Apparatus& apparatus, double seconds, std::size_t body = 0) {
    apparatus.advance_to(3.0 + seconds);
    return apparatus.bodies().at(body);
}

}  // namespace kinectlab::simulate
