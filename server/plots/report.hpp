#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace kinectlab::plots {

/// What a report is made of: things of one run and one version of its result.
struct ReportParts {
    std::string title;    ///< of the experiment
    std::string heading;  ///< "Run 12, rig-1, 2026-11-22 09:00 UTC, by Ada"
    const nlohmann::json& definition;
    const nlohmann::json& result;
    const nlohmann::json& plots;
};

/// HTML that prints as one page of A4 with six plots and sentences of usual length: results,
/// parameters, acceptance, budget, plots, provenance. Stands alone: pictures are inside, no script,
/// every text escaped.
[[nodiscard]] std::string report_html(const ReportParts& parts);

/// "9.8100 ± 0.0012": the uncertainty to two significant digits, the value to as many places.
[[nodiscard]] std::string with_uncertainty(double value, double u);

}  // namespace kinectlab::plots
