#include "server/plots/report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "server/plots/draw.hpp"
#include "server/plots/plot_json.hpp"

namespace kinectlab::plots {
namespace {

using nlohmann::json;

// One A4 page: tables side by side, the budget beside the sentences, three plots in a row.
constexpr const char* kStyle =
    "@page{size:A4;margin:9mm 10mm}"
    "body{font:8pt/1.25 system-ui,'DejaVu "
    "Sans',sans-serif;color:#20252c;width:190mm;margin:6mm auto}@media print{body{margin:0}}"
    "h1{font-size:15pt;margin:0}h2{font-size:9.5pt;margin:2.5mm 0 .6mm}p{margin:.6mm 0}"
    ".main{font-size:16pt;margin:1mm 0}.off{border-left:3px solid #b3541e;padding-left:3mm}"
    "table{border-collapse:collapse;width:100%}td,th{text-align:left;padding:.3mm 2mm .3mm 0;"
    "border-bottom:1px solid #dfe3e8;font-weight:normal;vertical-align:top}"
    "th{color:#5b6470}.n{font-variant-numeric:tabular-nums;white-space:nowrap}"
    ".three{display:grid;grid-template-columns:repeat(3,1fr);gap:2mm;margin-top:2mm}img{width:100%;"
    "display:block}"
    ".columns{display:flex;gap:6mm}.columns>div{flex:1 1 "
    "0;min-width:0}.columns>.more{flex-grow:1.1}"
    "small{color:#5b6470;font-size:7pt;overflow-wrap:anywhere}";
constexpr Sheet kSmall{400.0, 225.0, 225.0};

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        switch (c) {
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            case '&':
                safe += "&amp;";
                break;
            case '"':
                safe += "&quot;";
                break;
            default:
                safe += c;
        }
    }
    return safe;
}

/// The picture itself as an address, so that the page stands alone.
std::string picture(const std::string& svg, const std::string& words) {
    static const std::string kReserved = "%#\"<>&'";
    std::string address;
    for (const char c : svg) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte > 0x7e || kReserved.find(c) != std::string::npos)
            address += fmt::format("%{:02X}", byte);
        else
            address += c;
    }
    return fmt::format("<img alt=\"{}\" src=\"data:image/svg+xml,{}\">", escaped(words), address);
}

std::string text_of(const json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
    return value.is_null() ? "" : value.dump();
}

std::string row(const std::string& name, const std::string& value) {
    return "<tr><th>" + escaped(name) + "</th><td class=n>" + escaped(value) + "</td></tr>";
}

std::string unit_text(const std::string& unit) {
    return unit == "1" ? "" : " " + unit;
}

std::string results_table(const std::vector<Measurement>& results) {
    std::string html = "<table>";
    for (const auto& m : results)
        html += row(m.name, with_uncertainty(m.value, m.u) + unit_text(m.unit));
    return html + "</table>";
}

std::string parameter_table(const json& definition, const json& values) {
    std::string html = "<table>";
    for (const auto& [name, value] : values.items()) {
        std::string unit;
        for (const auto& p : definition.value("parameters", json::array()))
            if (p.value("name", "") == name) unit = p.value("unit", "");
        html += row(name, text_of(value) + unit_text(unit));
    }
    return html + "</table>";
}

std::string acceptance(const json& result) {
    const json checks = result.value("acceptance", json::array());
    if (checks.empty()) return {};
    std::string html = "<h2>What makes a good run</h2><table>";
    for (const auto& check : checks) {
        std::string range;
        if (check.contains("min")) range += "at least " + text_of(check["min"]);
        if (check.contains("max"))
            range += (range.empty() ? "at most " : ", at most ") + text_of(check["max"]);
        const bool ok = check.value("ok", false);
        const std::string seen =
            check.value("value", json()).is_null() ? "not known" : text_of(check["value"]);
        html += "<tr><th>" + escaped(check.value("fact", "")) + "</th><td>" +
                escaped(seen + " (" + range + ")") + "</td><td>" +
                (ok ? std::string("met") : "missed: " + escaped(check.value("reason", ""))) +
                "</td></tr>";
    }
    return html + "</table>";
}

std::string sentences(const json& result, const char* key, const char* heading) {
    const json list = result.value(key, json::array());
    if (list.empty()) return {};
    std::string html = std::string("<h2>") + heading + "</h2>";
    for (const auto& sentence : list)
        html += "<p>" + escaped(text_of(sentence)) + "</p>";
    return html;
}

std::string provenance(const json& result) {
    const json all = result.value("provenance", json::object());
    std::string html = "<h2>Where it comes from</h2><p><small>";
    for (const char* key :
         {"program",
          "version",
          "source",
          "run",
          "rig",
          "started",
          "analysed",
          "frames",
          "frames_tracked",
          "frames_lost",
          "samples_used",
          "outliers",
          "reduced_chi2",
          "lab_frame"}) {
        if (!all.contains(key)) continue;
        html += escaped(std::string(key) + ": " + text_of(all[key])) + "; ";
    }
    if (result.contains("analysis")) html += escaped("analysis: " + result["analysis"].dump());
    return html + "</small></p>";
}

}  // namespace

std::string with_uncertainty(double value, double u) {
    if (!(u > 0.0) || !std::isfinite(u) || !std::isfinite(value))
        return fmt::format("{:.6g}", value);
    const int places = 1 - static_cast<int>(std::floor(std::log10(u)));
    if (places >= 0 && places <= 9) return fmt::format("{0:.{2}f} ± {1:.{2}f}", value, u, places);
    const double power = std::pow(10.0, std::floor(std::log10(std::max(std::abs(value), u))));
    const int digits = std::max(0, 1 - static_cast<int>(std::floor(std::log10(u / power))));
    return fmt::format(
        "({0:.{3}f} ± {1:.{3}f})e{2:.0f}", value / power, u / power, std::log10(power), digits
    );
}

std::string report_html(const ReportParts& parts) {
    const auto results = measurements_from_json(parts.result.value("results", json::array()));
    const bool good = parts.result.value("accepted", true);
    std::string html = "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
                       escaped(parts.title + " - " + parts.heading) + "</title><style>" + kStyle +
                       "</style></head><body><h1>" + escaped(parts.title) + "</h1><p>" +
                       escaped(parts.heading) + "</p>";
    if (!results.empty()) {
        const Measurement& main = results.front();
        html += "<p class=main>" +
                escaped(
                    main.name + " = " + with_uncertainty(main.value, main.u) + unit_text(main.unit)
                ) +
                "</p><p><small>Standard uncertainty, k = 1.</small></p>";
    }
    if (!good)
        html +=
            "<p class=off>This run misses what a good one needs; read the checks below before "
            "you use its numbers.</p>";
    html += "<div class=columns><div><h2>Results</h2>" + results_table(results) +
            "</div><div><h2>Parameters</h2>" +
            parameter_table(parts.definition, parts.result.value("parameters", json::object())) +
            "</div></div>";
    html += acceptance(parts.result);
    html += "<div class=columns><div class=more><h2>Budget</h2>" +
            picture(draw_budget(results, Format::svg), "Shares of the uncertainty") +
            "</div><div>" + sentences(parts.result, "warnings", "Warnings") +
            sentences(parts.result, "notes", "Assumed and estimated") + "</div></div>";
    html += "<div class=three>";
    for (const auto& stored : parts.plots) {
        const Plot plot = plot_from_json(stored);
        html += picture(draw(plot, Format::svg, kSmall), plot.title);
    }
    return html + "</div>" + provenance(parts.result) + "</body></html>\n";
}

}  // namespace kinectlab::plots
