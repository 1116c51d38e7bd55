#include "server/plots/plot_json.hpp"

#include <limits>

#include <nlohmann/json.hpp>

namespace kinectlab::plots {
namespace {

using nlohmann::json;

std::vector<double> numbers(const json& object, const char* key) {
    std::vector<double> values;
    if (!object.contains(key)) return values;
    for (const auto& value : object[key])
        values.push_back(
            value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN()
        );
    return values;
}

}  // namespace

Plot plot_from_json(const json& document) {
    Plot plot{
        document.value("name", ""),
        document.value("title", ""),
        document.value("x_label", ""),
        document.value("y_label", ""),
        document.value("equal_axes", false),
        {}};
    for (const auto& series : document.value("series", json::array())) {
        PlotSeries read{
            series.value("name", ""),
            series.value("mark", "line") == "line" ? PlotMark::line : PlotMark::points,
            numbers(series, "x"),
            numbers(series, "y"),
            numbers(series, "u")};
        const std::size_t n = std::min(read.x.size(), read.y.size());
        read.x.resize(n);
        read.y.resize(n);
        plot.series.push_back(std::move(read));
    }
    return plot;
}

std::vector<Measurement> measurements_from_json(const json& results) {
    std::vector<Measurement> all;
    for (const auto& result : results) {
        Measurement m{
            result.value("name", ""),
            result.value("value", 0.0),
            result.value("u", 0.0),
            result.value("unit", ""),
            {}};
        for (const auto& line : result.value("budget", json::array()))
            m.budget.push_back({line.value("source", ""), line.value("u", 0.0)});
        all.push_back(std::move(m));
    }
    return all;
}

}  // namespace kinectlab::plots
