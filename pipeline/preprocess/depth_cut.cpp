#include "pipeline/preprocess/depth_cut.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Cholesky>

#include "pipeline/preprocess/wall_peak.hpp"

namespace kinectlab {
namespace {

constexpr int kSharp = 4;  // a peak that ends nearer is a wall across the optical axis

constexpr std::size_t kMostSamples = 8192;  // of the picture, for a slanted wall
constexpr double kBaseline_px = 32.0;       // over which slopes are taken: noise of 0.025 steps/px
constexpr int kSlopeBins = 64;
constexpr double kSlopeBin = 0.02;   // steps a pixel
constexpr int kCandidates = 3;       // planes tried
constexpr double kLensShare = 0.82;  // focal length of such cameras, of the picture's width
constexpr double kMostTilt = 1.7;    // tan 60°
constexpr std::array kGates{12.0, 6.0, 3.0, 3.0};  // steps about the plane, fit by fit

struct Sample {
    double u, v, s;
};

/// s = a u + b v + c, steps.
struct Plane {
    double a = 0.0, b = 0.0, c = 0.0;
    [[nodiscard]] double off(const Sample& p) const { return p.s - a * p.u - b * p.v - c; }
};

class SlantedWall {
public:
    SlantedWall(std::span<const float> disparity, int width, int row_step)
        : disparity_(disparity), width_(width), row_step_(row_step) {
        const std::size_t step = std::max<std::size_t>(1, disparity.size() / kMostSamples) | 1U;
        for (std::size_t i = 0; i < disparity.size(); i += step)
            if (disparity[i] > 0.0F) samples_.push_back(at(i));
    }

    std::optional<DepthCut> find() {
        if (samples_.size() < kMostSamples / 16) return std::nullopt;
        vote();
        for (int k = 0; k < kCandidates; ++k)
            if (const auto slope = next_slope())
                if (const auto cut = cut_along(*slope)) return cut;
        return std::nullopt;
    }

    /// A wall whose plane is nearly that of the histogram's peak.
    std::optional<DepthCut> find_near(double steps) {
        if (samples_.size() < kMostSamples / 16) return std::nullopt;
        return refined({0.0, 0.0, steps});
    }

private:
    [[nodiscard]] Sample at(std::size_t i) const {
        const auto width = static_cast<std::size_t>(width_);
        return {
            static_cast<double>(i % width),
            static_cast<double>(i / width) * row_step_,
            disparity_[i]};
    }

    /// Every sample votes for the slopes to the reading right of it and to that below.
    void vote() {
        constexpr int kAcross = static_cast<int>(kBaseline_px);
        const int rows = std::max(1, kAcross / row_step_);
        const auto down = static_cast<std::size_t>(rows) * static_cast<std::size_t>(width_);
        votes_.assign(kSlopeBins * kSlopeBins, 0);
        for (const auto& p : samples_) {
            const auto column = static_cast<int>(p.u);
            const auto i = static_cast<std::size_t>(static_cast<int>(p.v) / row_step_) *
                               static_cast<std::size_t>(width_) +
                           static_cast<std::size_t>(column);
            if (column + kAcross >= width_ || i + down >= disparity_.size()) continue;
            const double right = disparity_[i + static_cast<std::size_t>(kAcross)];
            const double below = disparity_[i + down];
            if (right <= 0.0 || below <= 0.0) continue;
            const auto bin = [](double slope) {
                return static_cast<int>(std::floor(slope / kSlopeBin)) + kSlopeBins / 2;
            };
            const int a = bin((right - p.s) / kAcross);
            const int b = bin((below - p.s) / (rows * row_step_));
            if (a < 0 || b < 0 || a >= kSlopeBins || b >= kSlopeBins) continue;
            ++votes_[static_cast<std::size_t>(b * kSlopeBins + a)];
        }
    }

    /// The slopes with most votes, which are then taken away.
    std::optional<Plane> next_slope() {
        double most = 0.0;
        int best_a = 0, best_b = 0;
        for (int b = 1; b + 1 < kSlopeBins; ++b)
            for (int a = 1; a + 1 < kSlopeBins; ++a) {
                const double votes = around(a, b, [](int& v) { return v; });
                if (votes <= most) continue;
                most = votes;
                best_a = a;
                best_b = b;
            }
        if (most < kWallShare * static_cast<double>(samples_.size()) / 4.0) return std::nullopt;
        around(best_a, best_b, [](int& v) { return v = 0; });
        const auto slope = [](int bin) {
            return (bin - kSlopeBins / 2 + 0.5) * kSlopeBin;
        };
        return Plane{slope(best_a), slope(best_b), 0.0};
    }

    template <class Take>
    double around(int a, int b, Take take) {
        double sum = 0.0;
        for (int y = b - 1; y <= b + 1; ++y)
            for (int x = a - 1; x <= a + 1; ++x)
                sum += take(votes_[static_cast<std::size_t>(y * kSlopeBins + x)]);
        return sum;
    }

    /// Histogram about a plane through the middle of the picture; `c` is where its middle lies.
    [[nodiscard]] Histogram histogram_about(const Plane& plane) const {
        Histogram bins{};
        for (const auto& p : samples_) {
            const int bin = static_cast<int>(std::floor(plane.off(p))) + kBins / 2;
            if (bin >= 0 && bin < kBins) ++bins[static_cast<std::size_t>(bin)];
        }
        return bins;
    }

    std::optional<DepthCut> cut_along(Plane plane) {
        const Sample middle = at(disparity_.size() / 2 + static_cast<std::size_t>(width_ / 2));
        plane.c = 200.0 - plane.a * middle.u - plane.b * middle.v;  // within the histogram's range
        const Histogram bins = histogram_about(plane);
        // The slopes are known to a bin only, so that the peak is flat: its farthest half will do.
        const auto peak = farthest_peak(bins, static_cast<double>(samples_.size()));
        if (!peak) return std::nullopt;
        plane.c += *peak - kBins / 2 + 0.5;
        return refined(plane);
    }

    std::optional<DepthCut> refined(Plane plane) {
        for (const double gate : kGates) {
            Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
            Eigen::Vector3d right = Eigen::Vector3d::Zero();
            for (const auto& p : samples_) {
                if (std::abs(plane.off(p)) > gate) continue;
                const Eigen::Vector3d row{p.u / 100.0, p.v / 100.0, 1.0};
                normal += row * row.transpose();
                right += p.s * row;
            }
            const auto solver = normal.ldlt();
            if (normal(2, 2) < 50.0 || solver.info() != Eigen::Success) return std::nullopt;
            const Eigen::Vector3d x = solver.solve(right);
            if (!x.allFinite()) return std::nullopt;
            plane = {x.x() / 100.0, x.y() / 100.0, x.z()};
        }
        if (grazing(plane)) return std::nullopt;
        const auto peak = wall_peak(histogram_about(plane));
        if (!peak || std::abs(peak->top - kBins / 2) > kHalfWindow) return std::nullopt;
        return DepthCut{plane.c + peak->foot - kBins / 2, plane.a, plane.b};
    }

    /// A plane's normal is (a f, b f, value in the middle of the picture), unscaled.
    [[nodiscard]] bool grazing(const Plane& plane) const {
        const Sample middle = at(disparity_.size() / 2 + static_cast<std::size_t>(width_ / 2));
        const double ahead = plane.a * middle.u + plane.b * middle.v + plane.c;
        const double f = kLensShare * width_;
        return ahead <= 0.0 || f * std::hypot(plane.a, plane.b) > kMostTilt * ahead;
    }

    std::span<const float> disparity_;
    int width_, row_step_;
    std::vector<Sample> samples_;
    std::vector<int> votes_;
};

}  // namespace

std::optional<DepthCut> wall_cut(std::span<const float> disparity, int width, int row_step) {
    if (disparity.empty() || width < 1) return std::nullopt;
    const auto peak = wall_peak(histogram_of(disparity));
    const std::optional<DepthCut> level =
        peak ? std::optional(DepthCut{static_cast<double>(peak->foot), 0.0, 0.0}) : std::nullopt;
    if (peak && peak->foot - peak->top <= kSharp) return level;
    SlantedWall slanted(disparity, width, row_step);
    if (peak)
        if (const auto cut = slanted.find_near(peak->top + 0.5)) return cut;
    if (const auto cut = slanted.find()) return cut;
    return level;
}

}  // namespace kinectlab
