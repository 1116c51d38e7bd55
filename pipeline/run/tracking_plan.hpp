#pragma once

#include <vector>

#include "pipeline/preprocess/settings.hpp"
#include "pipeline/track/object_spec.hpp"

namespace kinectlab {

/// What a person or an experiment asks of the chain: the objects to follow, and how frames are
/// prepared.
struct TrackingPlan {
    std::vector<ObjectSpec> objects;
    PreprocessSettings preprocess;
};

}  // namespace kinectlab
