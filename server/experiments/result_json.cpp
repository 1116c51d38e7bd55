#include "server/experiments/result_json.hpp"

#include <nlohmann/json.hpp>

namespace kinectlab::experiments {
namespace {

using nlohmann::json;

json to_json(const Pinhole& p) {
    return {
        {"width", p.width},
        {"height", p.height},
        {"fx", p.fx},
        {"fy", p.fy},
        {"cx", p.cx},
        {"cy", p.cy}};
}

json rows_of(const Eigen::Isometry3d& T) {
    json rows = json::array();
    for (int r = 0; r < 4; ++r)
        rows.push_back({T(r, 0), T(r, 1), T(r, 2), T(r, 3)});
    return rows;
}

json to_json(const Provenance& p) {
    json document = {
        {"program", "kinectlab"},
        {"version", p.program_version},
        {"source", p.source},
        {"camera", p.camera ? experiments::to_json(*p.camera) : json()},
        {"lab_frame", p.lab_frame_assumed ? "assumed: level camera that looks along y" : "known"},
        {"first_frame_ns", p.first_frame},
        {"last_frame_ns", p.last_frame},
        {"frames", p.frames},
        {"frames_tracked", p.frames_tracked},
        {"samples_used", p.samples_used},
        {"outliers", p.outliers},
        {"reduced_chi2", p.reduced_chi2}};
    if (!p.units.empty()) document["units"] = p.units;
    if (p.T_lab_cam) document["T_lab_cam"] = rows_of(*p.T_lab_cam);
    return document;
}

}  // namespace

json to_json(const Measurement& m) {
    json budget = json::array();
    for (const auto& line : m.budget)
        budget.push_back({{"source", line.source}, {"u", line.u}});
    return {
        {"name", m.name},
        {"value", m.value},
        {"u", m.u},
        {"unit", m.unit},
        {"k", 1},
        {"budget", std::move(budget)}};
}

json to_json(const RgbdCamera& c) {
    return {
        {"depth", to_json(c.depth)},
        {"colour", to_json(c.colour)},
        {"T_colour_depth", rows_of(c.T_colour_depth)},
        {"depth_unit_m", c.depth_unit_m},
        {"depth_scale_u", c.depth_scale_u},
        {"tilt_u_rad", c.tilt_u_rad},
        {"clock_u", c.clock_u},
        {"noise",
         {{"inverse_depth_step", c.noise.inverse_depth_step},
          {"sigma_steps", c.noise.sigma_steps}}}};
}

json result_to_json(
    const std::string& experiment,
    const std::map<std::string, double>& parameters,
    const std::vector<Measurement>& results,
    const std::vector<std::string>& warnings,
    const Provenance& provenance
) {
    json list = json::array();
    for (const auto& measurement : results)
        list.push_back(to_json(measurement));
    return {
        {"experiment", experiment},
        {"parameters", parameters},
        {"results", std::move(list)},
        {"warnings", warnings},
        {"provenance", to_json(provenance)}};
}

}  // namespace kinectlab::experiments
