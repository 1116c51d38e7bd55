#include "server/commands/fit_csv.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace kinectlab::commands {
namespace {

void append(std::string& csv, const Eigen::Vector3d& v) {
    for (int i = 0; i < 3; ++i) {
        csv += ',';
        if (!std::isfinite(v[i])) continue;
        std::array<char, 32> text{};
        csv.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), v[i]).ptr);
    }
}

}  // namespace

std::string fit_to_csv(const std::vector<ObjectFit>& fits) {
    std::string csv = "object,t_ns,x,y,z,fit_x,fit_y,fit_z,residual_x,residual_y,residual_z\n";
    for (const auto& fit : fits)
        for (std::size_t i = 0; i < fit.t.size(); ++i) {
            csv += fit.object + ',' + std::to_string(fit.t[i]);
            append(csv, fit.p_lab[i]);
            append(csv, fit.fit_lab[i]);
            append(csv, fit.residual[i]);
            csv += '\n';
        }
    return csv;
}

}  // namespace kinectlab::commands
