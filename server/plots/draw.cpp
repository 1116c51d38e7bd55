#include "server/plots/draw.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "server/plots/axis.hpp"
#include "server/plots/canvas.hpp"

namespace kinectlab::plots {
namespace {

constexpr double kWidth = 720.0;
constexpr double kMarkEach = 80.0;   // at most one mark for so much of the x axis ...
constexpr double kMarkEachY = 48.0;  // ... and of the y axis
constexpr double kLeft = 76.0;
constexpr double kRight = 18.0;
constexpr double kTop = 64.0;
constexpr double kBottom = 52.0;

struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void take(double value) {
        if (!std::isfinite(value)) return;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    [[nodiscard]] bool empty() const { return !(low <= high); }
};

/// From numbers to places on the sheet.
struct Frame {
    Axis x, y;
    double left = kLeft, top = kTop, width = 0.0, height = 0.0;

    [[nodiscard]] double across(double value) const {
        return left + (value - x.low) / (x.high - x.low) * width;
    }
    [[nodiscard]] double down(double value) const {
        return top + height - (value - y.low) / (y.high - y.low) * height;
    }
};

int marks_on(double length, double each) {
    return std::clamp(static_cast<int>(std::ceil(length / each)), 2, 8);
}

/// Widens the axis whose metre would be longer than the other's.
void make_equal(Frame& frame) {
    const double per_x = (frame.x.high - frame.x.low) / frame.width;
    const double per_y = (frame.y.high - frame.y.low) / frame.height;
    const double per = std::max(per_x, per_y);
    const auto widen = [](Axis& axis, double span) {
        const double middle = (axis.low + axis.high) / 2.0;
        axis.low = middle - span / 2.0;
        axis.high = middle + span / 2.0;
    };
    widen(frame.x, per * frame.width);
    widen(frame.y, per * frame.height);
    const double step = std::max(frame.x.step, frame.y.step);
    frame.x.step = frame.y.step = step;
}

void draw_axes(Canvas& canvas, const Frame& frame, const Plot& plot) {
    const double bottom = frame.top + frame.height;
    const double right = frame.left + frame.width;
    for (const double mark : frame.x.marks()) {
        canvas.line(frame.across(mark), frame.top, frame.across(mark), bottom, kFaint);
        canvas.text(frame.across(mark), bottom + 18.0, frame.x.label(mark), Align::centre);
    }
    for (const double mark : frame.y.marks()) {
        canvas.line(frame.left, frame.down(mark), right, frame.down(mark), kFaint);
        canvas.text(frame.left - 8.0, frame.down(mark) + 4.0, frame.y.label(mark), Align::right);
    }
    canvas.line(frame.left, bottom, right, bottom, kInk);
    canvas.line(frame.left, frame.top, frame.left, bottom, kInk);
    canvas.text(frame.left + frame.width / 2.0, bottom + 40.0, plot.x_label, Align::centre);
    canvas.text(18.0, frame.top + frame.height / 2.0, plot.y_label, Align::centre, 12.0, true);
}

void draw_line(Canvas& canvas, const Frame& frame, const PlotSeries& series, Colour colour) {
    bool down = false;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
        const bool there = std::isfinite(series.x[i]) && std::isfinite(series.y[i]);
        if (there && down) canvas.line_to(frame.across(series.x[i]), frame.down(series.y[i]));
        if (there && !down) canvas.move_to(frame.across(series.x[i]), frame.down(series.y[i]));
        down = there;
    }
    canvas.stroke(colour, 1.6);
}

void draw_points(Canvas& canvas, const Frame& frame, const PlotSeries& series, Colour colour) {
    const double radius = series.x.size() > 300 ? 1.4 : 2.4;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
        if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
        const double x = frame.across(series.x[i]);
        if (i < series.u.size() && std::isfinite(series.u[i]))
            canvas.line(
                x,
                frame.down(series.y[i] - series.u[i]),
                x,
                frame.down(series.y[i] + series.u[i]),
                colour,
                1.0
            );
        canvas.dot(x, frame.down(series.y[i]), radius, colour);
    }
}

void draw_legend(Canvas& canvas, const Plot& plot, double sheet_width) {
    double x = kLeft;
    double y = 46.0;
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const PlotSeries& series = plot.series[i];
        const Colour colour = curve_colour(i);
        const double width = 24.0 + canvas.text_width(series.name, 11.0);
        if (x > kLeft && x + width > sheet_width) {
            x = kLeft;
            y += 13.0;
        }
        if (series.mark == PlotMark::line)
            canvas.line(x, y, x + 18.0, y, colour, 2.0);
        else
            canvas.dot(x + 9.0, y, 3.0, colour);
        canvas.text(x + 24.0, y + 4.0, series.name, Align::left, 11.0);
        x += width + 18.0;
    }
}

}  // namespace

std::optional<Format> format_named(std::string_view name) {
    if (name == "svg") return Format::svg;
    if (name == "png") return Format::png;
    return std::nullopt;
}

std::string draw(const Plot& plot, Format format, const Sheet& sheet) {
    const double height = plot.equal_axes ? sheet.equal_height : sheet.height;
    Canvas canvas(sheet.width, height, format);
    canvas.text(kLeft, 26.0, plot.title, Align::left, 15.0);
    Range x;
    Range y;
    for (const auto& series : plot.series)
        for (std::size_t i = 0; i < series.x.size(); ++i) {
            if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
            x.take(series.x[i]);
            const double u = i < series.u.size() ? series.u[i] : 0.0;
            y.take(series.y[i] - (std::isfinite(u) ? u : 0.0));
            y.take(series.y[i] + (std::isfinite(u) ? u : 0.0));
        }
    if (x.empty()) {
        canvas.text(sheet.width / 2.0, height / 2.0, "nothing to show", Align::centre);
        return canvas.finish();
    }
    const double width = sheet.width - kLeft - kRight;
    const double high = height - kTop - kBottom;
    Frame frame{
        axis_for(x.low, x.high, marks_on(width, kMarkEach)),
        axis_for(y.low, y.high, marks_on(high, kMarkEachY))};
    frame.width = width;
    frame.height = high;
    if (plot.equal_axes) make_equal(frame);
    draw_axes(canvas, frame, plot);
    draw_legend(canvas, plot, sheet.width);
    canvas.clip(frame.left, frame.top, frame.width, frame.height);
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const auto& series = plot.series[i];
        if (series.mark == PlotMark::line)
            draw_line(canvas, frame, series, curve_colour(i));
        else
            draw_points(canvas, frame, series, curve_colour(i));
    }
    canvas.unclip();
    return canvas.finish();
}

std::string draw_budget(const std::vector<Measurement>& measurements, Format format) {
    std::vector<std::string> sources;
    for (const auto& m : measurements)
        for (const auto& line : m.budget)
            if (std::find(sources.begin(), sources.end(), line.source) == sources.end())
                sources.push_back(line.source);
    constexpr double kRow = 26.0;
    constexpr double kNames = 190.0;
    const double height = 96.0 + kRow * static_cast<double>(measurements.size());
    Canvas canvas(kWidth, height, format);
    canvas.text(18.0, 26.0, "Where the uncertainty comes from: shares of u²", Align::left, 15.0);
    double x = 18.0;
    double legend = 46.0;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const double width = 34.0 + canvas.text_width(sources[i], 11.0);
        if (x + width > kWidth - kRight) {
            x = 18.0;
            legend += 18.0;
        }
        canvas.box(x, legend - 9.0, 12.0, 12.0, curve_colour(i));
        canvas.text(x + 17.0, legend + 1.0, sources[i], Align::left, 11.0);
        x += width;
    }
    double y = legend + 18.0;
    const double span = kWidth - kNames - 110.0;
    for (const auto& m : measurements) {
        canvas.text(kNames - 8.0, y + 14.0, m.name, Align::right);
        double from = kNames;
        for (const auto& line : m.budget) {
            const double share = m.u > 0.0 ? line.u * line.u / (m.u * m.u) : 0.0;
            const auto at = static_cast<std::size_t>(
                std::find(sources.begin(), sources.end(), line.source) - sources.begin()
            );
            canvas.box(from, y + 2.0, share * span, kRow - 8.0, curve_colour(at));
            from += share * span;
        }
        canvas.text(
            kNames + span + 8.0,
            y + 14.0,
            fmt::format("{:.2g} {}", m.u, m.unit == "1" ? "" : m.unit),
            Align::left,
            11.0
        );
        y += kRow;
    }
    return canvas.finish();
}

}  // namespace kinectlab::plots
