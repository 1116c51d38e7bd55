#include "pipeline/analysis/spring_guess.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "pipeline/analysis/median.hpp"
#include "pipeline/analysis/swing_spectrum.hpp"

namespace kinectlab {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using std::numbers::pi;

constexpr double kFewestPeriods = 3.0;
constexpr double kFastest = 0.015;  // m: a pendulum of this length swings as fast as is looked for

Vector3d middle_of(std::span<const PositionSample> samples) {
    Vector3d middle;
    for (int k = 0; k < 3; ++k) {
        std::vector<double> x;
        for (const auto& s : samples)
            x.push_back(s.p_lab[k]);
        middle[k] = median(std::move(x));
    }
    return middle;
}

/// The direction of the largest spread; wild samples are pulled in.
Vector3d main_line(std::span<const PositionSample> samples) {
    const Vector3d middle = middle_of(samples);
    std::vector<double> off;
    for (const auto& s : samples)
        off.push_back((s.p_lab - middle).norm());
    const double limit = 3.0 * median(std::move(off));
    Matrix3d spread = Matrix3d::Zero();
    for (const auto& s : samples) {
        const Vector3d d = s.p_lab - middle;
        spread +=
            d * d.transpose() * std::min(1.0, limit * limit / std::max(d.squaredNorm(), 1e-300));
    }
    Vector3d line = Eigen::SelfAdjointEigenSolver<Matrix3d>(spread).eigenvectors().col(2);
    Eigen::Index most = 0;
    line.cwiseAbs().maxCoeff(&most);
    return line[most] < 0.0 ? Vector3d(-line) : line;
}

/// The samples as the spectrum takes them: the main line is its x.
std::vector<PositionSample> turned(
    std::span<const PositionSample> samples, const SpringAxes& axes
) {
    Matrix3d turn;
    turn << axes.along.transpose(), axes.side_a.transpose(), axes.side_b.transpose();
    std::vector<PositionSample> all(samples.begin(), samples.end());
    for (auto& s : all) {
        s.p_lab = turn * s.p_lab;
        s.whiten = s.whiten * turn.transpose();
        s.sigma =
            (turn * s.sigma.cwiseAbs2().asDiagonal() * turn.transpose()).diagonal().cwiseSqrt();
    }
    return all;
}

/// Coordinate along the line, fitted by constant and sines; what it leaves, and its coefficients.
struct Sines {
    double left = std::numeric_limits<double>::infinity();  ///< mean square
    double explained = 0.0;                                 ///< mean square
    VectorXd coefficients;
};

template <class Basis>
Sines fit_sines(
    std::span<const PositionSample> samples, const Vector3d& along, int n, const Basis& basis
) {
    MatrixXd normal = MatrixXd::Zero(n, n);
    VectorXd right = VectorXd::Zero(n);
    double squares = 0.0;
    double sum = 0.0;
    VectorXd row(n);
    const Vector3d origin = samples.front().p_lab;
    for (const auto& s : samples) {
        basis(s.t - samples.front().t, row);
        const double x = (s.p_lab - origin).dot(along);
        normal.noalias() += row * row.transpose();
        right += row * x;
        squares += x * x;
        sum += x;
    }
    Sines out;
    const auto count = static_cast<double>(samples.size());
    out.coefficients = normal.ldlt().solve(right);
    if (!out.coefficients.allFinite()) return out;
    out.left = std::max((squares - out.coefficients.dot(right)) / count, 0.0);
    out.explained = squares / count - sum * sum / (count * count) - out.left;
    return out;
}

SpringGuess with(
    std::span<const PositionSample> samples, const Stretch& known, const SpringAxes& axes
) {
    SpringGuess guess{known, samples[known.begin].t, axes, VectorXd::Zero(kSpringParameters)};
    guess.parameters.head<3>() = middle_of(samples.subspan(known.begin, known.size()));
    return guess;
}

Error still() {
    return {
        ErrorCode::bad_data,
        "samples",
        "nothing swings to and fro beyond the positions' noise",
        "pull the mass down farther and let it go, with three periods or more in view"};
}

Result<SpringGuess> guess_free(std::span<const PositionSample> samples, const SpringAxes& axes) {
    const auto f = find_frequency(turned(samples, axes), kFastest);
    if (!f) return tl::unexpected(still());
    const double period = 1.0 / *f;
    const double all = samples.back().t - samples.front().t;
    if (all < kFewestPeriods * period)
        return fail(
            ErrorCode::bad_data,
            "samples",
            fmt::format("there are {:.1f} periods of {:.2f} s", all / period, period),
            "record three periods or more"
        );
    Sines best;
    Stretch known;
    double most = 0.0;
    const auto damped = [&](double t, VectorXd& row) {
        const double phase = 2.0 * pi * *f * t;
        row << 1.0, std::cos(phase), std::sin(phase), t * std::cos(phase), t * std::sin(phase);
    };
    for (std::size_t begin = 0, next = 0; begin < samples.size(); begin = next) {
        std::size_t end = begin;
        while (end < samples.size() && samples[end].t - samples[begin].t < kFewestPeriods * period)
            ++end;
        next = begin + 1;
        while (next < samples.size() && samples[next].t - samples[begin].t < period / 2.0)
            ++next;
        if (end == samples.size() && begin > 0 &&
            samples.back().t - samples[begin].t < 0.97 * kFewestPeriods * period)
            break;
        if (end - begin < 12) continue;
        const Sines sines = fit_sines(samples.subspan(begin, end - begin), axes.along, 5, damped);
        const double clear = sines.explained * sines.explained / std::max(sines.left, 1e-300);
        if (!(clear > most)) continue;
        most = clear;
        best = sines;
        known = {begin, end};
    }
    if (best.left > 0.2 * best.explained)
        return fail(
            ErrorCode::bad_data,
            "samples",
            "what moves does not swing like a mass on a spring for three periods",
            "see that the right object is followed, and let it swing freely for longer"
        );
    SpringGuess guess = with(samples, known, axes);
    VectorXd& x = guess.parameters;
    const VectorXd& c = best.coefficients;
    x[kSpringOmega] = 2.0 * pi * *f;
    x[kSpringCos] = c[1];
    x[kSpringSin] = c[2];
    const double amplitude_sq = c[1] * c[1] + c[2] * c[2];
    x[kSpringDamping] =
        std::clamp(-(c[1] * c[3] + c[2] * c[4]) / amplitude_sq, 0.0, 0.3 * x[kSpringOmega]);
    return guess;
}

Result<SpringGuess> guess_driven(
    std::span<const PositionSample> samples, const SpringAxes& axes, double drive
) {
    const std::size_t n = samples.size();
    SpringGuess best;
    double least = std::numeric_limits<double>::infinity();
    double explained = 0.0;
    for (const Stretch& part :
         {Stretch{0, n}, Stretch{n / 2, n}, Stretch{n / 4, 3 * n / 4}, Stretch{0, n / 2}}) {
        const auto some = samples.subspan(part.begin, part.size());
        const double periods = (some.back().t - some.front().t) * drive / (2.0 * pi);
        if (periods < kFewestPeriods || some.size() < 30) continue;
        for (double omega = 0.3 * drive; omega < 3.0 * drive; omega *= 1.015)
            for (const double gamma : {0.005, 0.02, 0.06, 0.15}) {
                if (std::abs(omega - drive) < 0.01 * drive && gamma == 0.005) continue;
                const auto basis = [&](double t, VectorXd& row) {
                    const double decay = std::exp(-gamma * omega * t);
                    row << 1.0, decay * std::cos(omega * t), decay * std::sin(omega * t),
                        std::cos(drive * t), std::sin(drive * t);
                };
                const Sines sines = fit_sines(some, axes.along, 5, basis);
                // A longer part is worth some more scatter.
                const double worth = part.size() == n ? 0.5 : 1.0;
                if (!(worth * sines.left < least)) continue;
                least = worth * sines.left;
                explained = sines.explained;
                best = with(samples, part, axes);
                VectorXd& x = best.parameters;
                x[kSpringOmega] = omega;
                x[kSpringDamping] = gamma * omega;
                x[kSpringCos] = sines.coefficients[1];
                x[kSpringSin] = sines.coefficients[2];
                x[kSpringDriveOmega] = drive;
                x[kSpringDriveCos] = sines.coefficients[3];
                x[kSpringDriveSin] = sines.coefficients[4];
            }
    }
    if (!std::isfinite(least))
        return fail(
            ErrorCode::bad_data,
            "samples",
            "there are fewer than three periods of the drive",
            "record for longer, or see that drive_hz is right"
        );
    if (least > 0.2 * explained)
        return fail(
            ErrorCode::bad_data,
            "samples",
            "what moves does not follow a drive of that frequency",
            "see that drive_hz is right and that the right object is followed"
        );
    return best;
}

}  // namespace

Result<SpringGuess> guess_spring(std::span<const PositionSample> samples, double drive_omega) {
    const SpringAxes axes = spring_axes(main_line(samples));
    const double noise = noise_excess(samples) * samples[samples.size() / 2].sigma.minCoeff();
    const Vector3d middle = middle_of(samples);
    std::vector<double> off;
    for (const auto& s : samples)
        off.push_back(std::abs((s.p_lab - middle).dot(axes.along)));
    if (median(std::move(off)) < noise * 1e-3) return tl::unexpected(still());
    return drive_omega > 0.0 ? guess_driven(samples, axes, drive_omega) : guess_free(samples, axes);
}

}  // namespace kinectlab
