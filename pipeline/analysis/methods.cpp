#include "pipeline/analysis/methods.hpp"

namespace kinectlab {

const std::vector<AnalysisMethod>& analysis_methods() {
    static const std::vector<AnalysisMethod> kMethods = {pendulum_method(), foucault_method()};
    return kMethods;
}

}  // namespace kinectlab
