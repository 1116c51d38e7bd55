#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "pipeline/features/sift3d.hpp"

namespace kinectlab {
namespace {

constexpr int kCells = 4, kAzimuths = 8, kElevations = 4;
constexpr float kCell_sigmas = 2.0F;  // side of a cell, in the keypoint's σ
constexpr std::size_t kFewestVoxels = 25;
constexpr int kTurns = 36;           // bins of the dominant gradient's direction
constexpr float kSecondTurn = 0.8F;  // of the highest bin: described a second time
constexpr float kMostOfOne = 0.1F;   // no number outweighs all others (Lowe 2004, 6.1)
constexpr float kPi = std::numbers::pi_v<float>;

/// A voxel near a keypoint: where it is, and how its value changes.
struct Sample {
    Eigen::Vector3f off = Eigen::Vector3f::Zero();  // from the keypoint, m
    Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
};

/// The surface around a keypoint, walked from neighbour to neighbour: what lies behind it belongs
/// to something else and is not reached.
class Patch {
public:
    explicit Patch(const SurfaceOctave& octave)
        : octave_(octave), seen_at_(octave.surface.size(), 0) {}

    std::span<const Sample> around(const Keypoint3d& keypoint, float radius_m) {
        ++round_;
        queue_.assign(1, keypoint.voxel);
        seen_at_[keypoint.voxel] = round_;
        samples_.clear();
        for (std::size_t next = 0; next < queue_.size(); ++next) {
            const std::uint32_t voxel = queue_[next];
            samples_.push_back(
                {octave_.surface.p_cam[voxel] - keypoint.p_cam, gradient(voxel, keypoint.layer)}
            );
            for (const auto i : octave_.neighbours.of(voxel)) {
                if (seen_at_[i] == round_) continue;
                seen_at_[i] = round_;
                if ((octave_.surface.p_cam[i] - keypoint.p_cam).norm() < radius_m)
                    queue_.push_back(i);
            }
        }
        return samples_;
    }

private:
    /// Least squares over the neighbours; across the surface nothing is known, and a little of the
    /// trace keeps that direction at zero.
    [[nodiscard]] Eigen::Vector3f gradient(std::uint32_t voxel, std::size_t layer) const {
        const auto value = [&](std::uint32_t i) {
            return octave_.blurred[i * SurfaceOctave::kLanes + layer];
        };
        Eigen::Matrix3f moments = Eigen::Matrix3f::Zero();
        Eigen::Vector3f sums = Eigen::Vector3f::Zero();
        for (const auto i : octave_.neighbours.of(voxel)) {
            const Eigen::Vector3f off = octave_.surface.p_cam[i] - octave_.surface.p_cam[voxel];
            moments += off * off.transpose();
            sums += off * (value(i) - value(voxel));
        }
        const float trace = moments.trace();
        if (!(trace > 0.0F)) return Eigen::Vector3f::Zero();
        moments.diagonal().array() += 0.05F * trace;
        return moments.inverse() * sums;
    }

    const SurfaceOctave& octave_;
    std::vector<std::uint32_t> seen_at_;  // round in which a voxel was reached last
    std::uint32_t round_ = 0;
    std::vector<std::uint32_t> queue_;
    std::vector<Sample> samples_;
};

float nearness(const Sample& sample, float sigma_m) {
    return std::exp(-0.5F * sample.off.squaredNorm() / (sigma_m * sigma_m));
}

/// The direction of least spread, towards the camera.
Eigen::Vector3f normal_of(std::span<const Sample> samples, const Keypoint3d& keypoint) {
    const float sigma_m = 2.5F * keypoint.scale_m;
    Eigen::Matrix3f spread = Eigen::Matrix3f::Zero();
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    float total = 0.0F;
    for (const auto& sample : samples) {
        const float weight = nearness(sample, sigma_m);
        mean += weight * sample.off;
        spread += weight * sample.off * sample.off.transpose();
        total += weight;
    }
    mean /= total;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver(
        spread / total - mean * mean.transpose()
    );
    const Eigen::Vector3f normal = solver.eigenvectors().col(0);
    return normal.dot(keypoint.p_cam) > 0.0F ? Eigen::Vector3f(-normal) : normal;
}

/// Angles of the gradient across the surface that stand out, against the axis `x`.
std::vector<float> dominant_turns(
    std::span<const Sample> samples,
    const Eigen::Vector3f& x,
    const Eigen::Vector3f& y,
    float scale_m
) {
    std::array<float, kTurns> histogram{};
    for (const auto& sample : samples) {
        const float a = sample.gradient.dot(x), b = sample.gradient.dot(y);
        const float weight = std::hypot(a, b) * nearness(sample, 1.5F * kCell_sigmas * scale_m);
        const float at = (std::atan2(b, a) / (2.0F * kPi) + 1.0F) * kTurns;
        const auto bin = static_cast<std::size_t>(at);
        const float part = at - std::floor(at);
        histogram[bin % kTurns] += weight * (1.0F - part);
        histogram[(bin + 1) % kTurns] += weight * part;
    }
    for (int pass = 0; pass < 2; ++pass) {
        auto smooth = histogram;
        for (std::size_t i = 0; i < kTurns; ++i)
            smooth[i] = 0.5F * histogram[i] + 0.25F * (histogram[(i + 1) % kTurns] +
                                                       histogram[(i + kTurns - 1) % kTurns]);
        histogram = smooth;
    }
    const float highest = *std::max_element(histogram.begin(), histogram.end());
    std::vector<std::pair<float, float>> peaks;
    for (std::size_t i = 0; i < kTurns && highest > 0.0F; ++i) {
        const float before = histogram[(i + kTurns - 1) % kTurns], here = histogram[i],
                    after = histogram[(i + 1) % kTurns];
        if (here < kSecondTurn * highest || here <= before || here < after) continue;
        const float shift = 0.5F * (before - after) / (before - 2.0F * here + after);
        peaks.emplace_back(here, (static_cast<float>(i) + shift) * 2.0F * kPi / kTurns);
    }
    std::sort(peaks.rbegin(), peaks.rend());
    std::vector<float> turns;
    for (std::size_t i = 0; i < std::min<std::size_t>(2, peaks.size()); ++i)
        turns.push_back(peaks[i].second);
    return turns;
}

/// The two bins next to a place on an axis, and the share of the second.
struct Between {
    int low;
    float share;
    explicit Between(float at)
        : low(static_cast<int>(std::floor(at))), share(at - std::floor(at)) {}
};

/// Spreads one gradient over the up to 32 bins around it, so that no border shows.
void add(const Eigen::Vector3f& cell, float azimuth, float elevation, float weight, float* out) {
    const Between x(cell.x()), y(cell.y()), z(cell.z()), a(azimuth), e(elevation);
    for (int corner = 0; corner < 32; ++corner) {
        const auto pick = [&](const Between& between, int bit, float& share) {
            const bool high = (corner >> bit & 1) != 0;
            share *= high ? between.share : 1.0F - between.share;
            return between.low + (high ? 1 : 0);
        };
        float share = weight;
        const int i = pick(x, 0, share), j = pick(y, 1, share), k = pick(z, 2, share);
        const int m = (pick(a, 3, share) + kAzimuths) % kAzimuths;
        const int n = std::clamp(pick(e, 4, share), 0, kElevations - 1);
        if (i < 0 || j < 0 || k < 0 || i >= kCells || j >= kCells || k >= kCells) continue;
        out[(((i * kCells + j) * kCells + k) * kAzimuths + m) * kElevations + n] += share;
    }
}

void normalise(float* numbers) {
    using Vector = Eigen::Map<Eigen::Matrix<float, kSift3dLength, 1>>;
    Vector vector(numbers);
    for (int pass = 0; pass < 2; ++pass) {
        const float length = vector.norm();
        if (!(length > 0.0F)) return;
        vector /= length;
        if (pass == 0) vector = vector.cwiseMin(kMostOfOne);
    }
}

void describe(
    std::span<const Sample> samples, const Eigen::Matrix3f& axes, float scale_m, float* out
) {
    const float cell_m = kCell_sigmas * scale_m;
    for (const auto& sample : samples) {
        const Eigen::Vector3f gradient = axes.transpose() * sample.gradient;
        const float length = gradient.norm();
        if (!(length > 0.0F)) continue;
        const Eigen::Vector3f place = axes.transpose() * sample.off / cell_m;
        const float azimuth =
            (std::atan2(gradient.y(), gradient.x()) / (2.0F * kPi) + 1.0F) * kAzimuths;
        const float elevation =
            (std::asin(std::clamp(gradient.z() / length, -1.0F, 1.0F)) / kPi + 0.5F) * kElevations -
            0.5F;
        const float weight = length * nearness(sample, 2.0F * cell_m);
        const Eigen::Vector3f cell = place.array() + (0.5F * kCells - 0.5F);
        add(cell, std::fmod(azimuth, static_cast<float>(kAzimuths)), elevation, weight, out);
    }
    normalise(out);
}

}  // namespace

Descriptors3d sift3d_descriptors(
    std::span<const SurfaceOctave> octaves, std::span<const Keypoint3d> keypoints
) {
    Descriptors3d found;
    std::vector<Patch> patches(octaves.begin(), octaves.end());
    for (std::uint32_t i = 0; i < keypoints.size(); ++i) {
        const Keypoint3d& keypoint = keypoints[i];
        const float radius_m = 0.5F * kCells * kCell_sigmas * keypoint.scale_m * 1.3F;
        const auto samples = patches[keypoint.octave].around(keypoint, radius_m);
        if (samples.size() < kFewestVoxels) continue;
        const Eigen::Vector3f normal = normal_of(samples, keypoint);
        const Eigen::Vector3f x = normal.unitOrthogonal();
        const Eigen::Vector3f y = normal.cross(x);
        for (const float turn : dominant_turns(samples, x, y, keypoint.scale_m)) {
            Eigen::Matrix3f axes;
            axes.col(0) = std::cos(turn) * x + std::sin(turn) * y;
            axes.col(1) = normal.cross(axes.col(0));
            axes.col(2) = normal;
            found.keypoint.push_back(i);
            found.numbers.resize(found.numbers.size() + kSift3dLength, 0.0F);
            describe(
                samples,
                axes,
                keypoint.scale_m,
                &found.numbers[found.numbers.size() - kSift3dLength]
            );
        }
    }
    return found;
}

}  // namespace kinectlab
