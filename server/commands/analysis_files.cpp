#include "server/commands/analysis_files.hpp"

#include <nlohmann/json.hpp>

#include "server/commands/fit_csv.hpp"
#include "server/commands/output.hpp"
#include "server/commands/pose_table.hpp"
#include "server/plots/draw.hpp"
#include "server/plots/report.hpp"

namespace kinectlab::commands {
namespace {

/// Every plot and the budget as NAME.svg and NAME.png, and all of it as one page to print.
Result<void> write_pictures(
    const std::filesystem::path& folder,
    const experiments::Definition& definition,
    const experiments::Evaluation& evaluation
) {
    const auto write = [&](const std::string& name, auto&& draw) {
        return write_text_file(folder / (name + ".svg"), draw(plots::Format::svg)).and_then([&] {
            return write_text_file(folder / (name + ".png"), draw(plots::Format::png));
        });
    };
    auto written = write("budget", [&](plots::Format format) {
        return plots::draw_budget(evaluation.outcome.measurements, format);
    });
    for (const auto& plot : evaluation.outcome.plots)
        written = written.and_then([&] {
            return write(plot.name, [&](plots::Format format) {
                return plots::draw(plot, format);
            });
        });
    return written.and_then([&] {
        const auto source = evaluation.result["provenance"].value("source", "");
        return write_text_file(
            folder / "report.html",
            plots::report_html(
                {definition.title,
                 "Measured from " + source,
                 experiments::to_json(definition),
                 evaluation.result,
                 evaluation.plots}
            )
        );
    });
}

}  // namespace

Result<void> write_analysis(
    const std::filesystem::path& folder,
    const experiments::Definition& definition,
    const experiments::Evaluation& evaluation,
    const std::vector<Trajectory>& trajectories
) {
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    if (code)
        return fail(
            ErrorCode::unavailable,
            folder.string(),
            "cannot be made: " + code.message(),
            "name a folder that you may write to"
        );
    return write_text_file(folder / "poses.csv", poses_to_csv(trajectories))
        .and_then([&] {
            return write_text_file(folder / "fit.csv", fit_to_csv(evaluation.outcome.fits));
        })
        .and_then([&] {
            return write_text_file(folder / "plots.json", evaluation.plots.dump() + "\n");
        })
        .and_then([&] { return write_pictures(folder, definition, evaluation); })
        .and_then([&] {
            return write_text_file(folder / "result.json", evaluation.result.dump(1) + "\n");
        });
}

}  // namespace kinectlab::commands
