#include "pipeline/analysis/methods.hpp"

namespace kinectlab {

const std::vector<AnalysisMethod>& analysis_methods() {
    static const std::vector<AnalysisMethod> kMethods = {
        pendulum_method(),
        foucault_method(),
        projectile_method(),
        incline_method(),
        spring_method(),
        collision_method(),
        rigid_body_method(),
        path_method()};
    return kMethods;
}

}  // namespace kinectlab
