#include "pipeline/track/model_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

namespace kinectlab {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr std::size_t kFewestPoints = 40;
constexpr int kStepsARound = 5;
constexpr double kGateSigmas = 4.0;          // of Tukey's weight in the end
constexpr double kAgreeSigmas = 3.5;         // of a reading that lies on the surface
constexpr double kAgreeFloorM = 0.003;       // models and sensors are no better than this
constexpr double kOutlineJumpSigmas = 10.0;  // in disparity: what is behind an outline
constexpr double kOutlineSigmaPx = 0.7;
constexpr double kShadowSigmaPx = 2.0;  // an outline beside pixels without a reading
constexpr int kOutlineFar = 14;         // px across an outline looked at in the first round
constexpr int kOutlineNear = 5;         // and from then on
constexpr int kMostRounds = 4;
constexpr std::size_t kSides = 16;         // directions of an outline that err together
constexpr double kSide_px = 0.29;          // 1/sqrt(12): a rim is at one pixel or the next
constexpr double kOutlineShared_px = 7.0;  // so far along the outline readings err together
constexpr int kMostShadow = 12;  // px without a reading between the object and what is behind

double tukey(double residual, double gate) {
    const double share = residual / gate;
    if (std::abs(share) >= 1.0) return 0.0;
    const double w = 1.0 - share * share;
    return w * w;
}

/// Negative left of the first pixel; std::lround is a call, and this the innermost loop.
int nearest_pixel(double x) {
    return x > -0.5 ? static_cast<int>(x + 0.5) : -1;
}

Eigen::Matrix3d turn(const Eigen::Vector3d& rotation) {
    const double angle = rotation.norm();
    if (angle < 1e-12) return Eigen::Matrix3d::Identity();
    return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
}

Eigen::Vector3d rotation_between(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
    const Eigen::AngleAxisd turned(to * from.transpose());
    return turned.angle() * turned.axis();
}

}  // namespace

/// Normal equations of one step, and the tally of what the readings say.
struct ModelFitter::Equations {
    Matrix6d surface = Matrix6d::Zero(), outline = Matrix6d::Zero();  ///< lower halves
    Vector6d gradient = Vector6d::Zero();
    double squares = 0.0, weights = 0.0;
    std::size_t offered = 0, agree = 0, farther = 0, unread = 0;
    std::size_t outline_offered = 0, outline_found = 0;
    /// What a side of the outline would pull if all of it were a pixel further out.
    std::array<Vector6d, kSides> sides;

    Equations() { sides.fill(Vector6d::Zero()); }

    void add_surface(const Vector6d& j, double residual, double weight) {
        surface.selfadjointView<Eigen::Lower>().rankUpdate(j, weight);
        gradient += weight * residual * j;
    }
    void add_outline(
        const Vector6d& j, double residual, double weight, const Eigen::Vector2d& outwards
    ) {
        outline.selfadjointView<Eigen::Lower>().rankUpdate(j, weight);
        gradient += weight * residual * j;
        const double turn = std::atan2(outwards.y(), outwards.x()) / (2.0 * std::numbers::pi);
        sides[static_cast<std::size_t>(kSides * (turn + 1.0) + 0.5) % kSides] += weight * j;
    }
    [[nodiscard]] Matrix6d information(const Vector6d& prior) const {
        Matrix6d all = (surface + outline).selfadjointView<Eigen::Lower>();
        all.diagonal() += prior;
        return all;
    }
    /// Covariance of the gradient: neighbours err together, on the surface by so much more variance
    /// than if each erred for itself, along the outline over a window, and a whole side where it
    /// runs along the picture's rows.
    [[nodiscard]] Matrix6d gradient_covariance(
        double surface_inflation, double outline_step_px, const Vector6d& prior
    ) const {
        const double shared = std::max(1.0, kOutlineShared_px / outline_step_px);
        Matrix6d all =
            (surface_inflation * surface + shared * outline).selfadjointView<Eigen::Lower>();
        for (const auto& side : sides)
            all += kSide_px * kSide_px * side * side.transpose();
        all.diagonal() += prior;
        return all;
    }
};

ModelFitter::ModelFitter(const RgbdCamera& camera, const ModelViewer::Settings& view)
    : camera_(camera), scale_(camera), viewer_(camera.depth, view), noise_(camera.depth) {}

void ModelFitter::add_surface(
    std::span<const std::uint16_t> depth,
    const ModelView& view,
    const Eigen::Isometry3d& T,
    double gate_m,
    Equations& sums
) {
    readings_.pixel.clear();
    readings_.weight.clear();
    readings_.residual.clear();
    const Pinhole& k = camera_.depth;
    const Eigen::Vector3d centre = T.translation();
    for (const auto& point : view.surface) {
        const Eigen::Vector3d p = T * point.p_obj;
        if (p.z() < 0.05) continue;
        const auto u = nearest_pixel(k.fx * p.x() / p.z() + k.cx);
        const auto v = nearest_pixel(k.fy * p.y() / p.z() + k.cy);
        if (u < 0 || v < 0 || u >= k.width || v >= k.height) continue;
        const auto pixel = static_cast<std::uint32_t>(v * k.width + u);
        const std::uint16_t counts = depth[pixel];
        if (counts == 0) {
            ++sums.unread;
            continue;
        }
        const Eigen::Vector3d n = T.linear() * point.n_obj;
        const Eigen::Vector3d ray = k.ray(u, v);
        const double n_ray = n.dot(ray);
        if (n_ray > -0.1) continue;  // turned away since it was drawn
        const double z = n.dot(p) / n_ray;
        if (!(z > 0.05)) continue;
        const double predicted = scale_.steps_at(z);
        const double sigma = scale_.sigma_at(predicted);
        const double residual = (scale_.steps(counts) - predicted) / sigma;
        const double sigma_m = sigma * scale_.inverse_depth_step * z * z;
        const double agree = std::max(kAgreeSigmas, kAgreeFloorM / sigma_m);
        ++sums.offered;
        if (residual < -agree) ++sums.farther;
        if (std::abs(residual) <= agree) ++sums.agree;
        const double weight = tukey(residual, std::max(kGateSigmas, gate_m / sigma_m));
        if (weight == 0.0) continue;
        const double slope = -1.0 / (scale_.inverse_depth_step * n_ray * z * z * sigma);
        Vector6d j;
        j.head<3>() = slope * n;
        j.tail<3>() = slope * (z * ray - centre).cross(n);
        sums.add_surface(j, residual, weight);
        readings_.pixel.push_back(pixel);
        readings_.weight.push_back(static_cast<float>(weight));
        readings_.residual.push_back(static_cast<float>(residual));
        sums.squares += weight * residual * residual * sigma * sigma;
        sums.weights += weight;
    }
}

void ModelFitter::add_outline(
    std::span<const std::uint16_t> depth,
    const ModelView& view,
    const Eigen::Isometry3d& T,
    int reach,
    Equations& sums
) const {
    const Pinhole& k = camera_.depth;
    const int samples = 2 * reach + kMostShadow + 1;
    enum class Shown : std::uint8_t { nothing, object, behind, before, outside };
    std::array<Shown, 2 * kOutlineFar + kMostShadow + 1> shown{};
    for (const auto& point : view.outline) {
        const Eigen::Vector3d p = T * point.p_obj;
        if (p.z() < 0.05) continue;
        const Eigen::Vector2d at = k.project(p);
        const double own = scale_.steps_at(p.z());
        const double jump = kOutlineJumpSigmas * scale_.sigma_at(own);
        for (int i = 0; i < samples; ++i) {
            const Eigen::Vector2d x = at + (i - reach - 0.5) * point.outwards;
            const auto u = nearest_pixel(x.x());
            const auto v = nearest_pixel(x.y());
            auto& what = shown[static_cast<std::size_t>(i)];
            if (u < 0 || v < 0 || u >= k.width || v >= k.height) {
                what = Shown::outside;
                continue;
            }
            const std::uint16_t counts = depth[static_cast<std::size_t>(v * k.width + u)];
            const double off = counts == 0 ? 0.0 : scale_.steps(counts) - own;
            what = counts == 0      ? Shown::nothing
                   : off < -jump    ? Shown::behind
                   : off > 2 * jump ? Shown::before
                                    : Shown::object;
        }
        ++sums.outline_offered;
        // The rim nearest to the one expected: the object's last pixel before what is behind it.
        double best = 1e9, sigma = kOutlineSigmaPx;
        for (int i = 0; i < 2 * reach + 1; ++i) {
            if (shown[static_cast<std::size_t>(i)] != Shown::object) continue;
            int next = i + 1;
            while (next < samples && shown[static_cast<std::size_t>(next)] == Shown::nothing)
                ++next;
            if (next == samples || shown[static_cast<std::size_t>(next)] != Shown::behind) continue;
            const double found = i - reach;  // px from the rim expected
            if (std::abs(found) >= std::abs(best)) continue;
            best = found;
            sigma = next == i + 1 ? kOutlineSigmaPx : kShadowSigmaPx;
        }
        const double weight = tukey(best, reach) / (sigma * sigma);
        if (weight == 0.0) continue;
        if (std::abs(best) < 2.0) ++sums.outline_found;
        const double inverse = 1.0 / p.z();
        const Eigen::Vector3d across(
            k.fx * inverse * point.outwards.x(),
            k.fy * inverse * point.outwards.y(),
            -inverse * inverse *
                (k.fx * p.x() * point.outwards.x() + k.fy * p.y() * point.outwards.y())
        );
        Vector6d j;
        j.head<3>() = across;
        j.tail<3>() = (p - T.translation()).cross(across);
        sums.add_outline(j, best, weight, point.outwards);
    }
}

std::optional<ModelFit> ModelFitter::fit(
    std::span<const std::uint16_t> depth,
    const ObjectModel& model,
    const Eigen::Isometry3d& T_start,
    const ModelFitStart& start,
    int rounds
) {
    Eigen::Isometry3d T = T_start;
    Vector6d prior;
    prior.head<3>().setConstant(1.0 / (start.sigma_m * start.sigma_m));
    prior.tail<3>().setConstant(1.0 / (start.sigma_rad * start.sigma_rad));
    Equations sums;
    double gate_m = start.gate_m;
    int reach = kOutlineFar;
    for (int round = 0; round < rounds; ++round) {
        const ModelView& view = viewer_.look(model, T);
        if (view.surface.size() < kFewestPoints) return std::nullopt;
        for (int step = 0; step < kStepsARound; ++step) {
            sums = {};
            add_surface(depth, view, T, gate_m, sums);
            if (sums.offered < kFewestPoints) return std::nullopt;
            add_outline(depth, view, T, reach, sums);
            Vector6d off;  // from the start: the prior pulls back what nothing else holds
            off.head<3>() = T.translation() - T_start.translation();
            off.tail<3>() = rotation_between(T_start.linear(), T.linear());
            const Vector6d change =
                sums.information(prior).ldlt().solve(sums.gradient - prior.cwiseProduct(off));
            if (!change.allFinite()) return std::nullopt;
            T.linear() = turn(change.tail<3>()) * T.linear();
            T.translation() += change.head<3>();
            gate_m *= 0.6;
            if (change.head<3>().norm() < 2e-5 && change.tail<3>().norm() < 2e-4) break;
        }
        gate_m = std::min(gate_m, 0.25 * start.gate_m);
        // A face slides along itself until its outline is within reach.
        const bool is_far = 10 * sums.outline_found < 3 * sums.outline_offered;
        if (is_far && round == rounds - 1 && rounds < kMostRounds) ++rounds;
        if (!is_far) reach = kOutlineNear;
    }
    // What is told of the fit is told at its end.
    const ModelView& view = viewer_.look(model, T);
    sums = {};
    add_surface(depth, view, T, 0.0, sums);
    if (sums.offered < kFewestPoints || sums.weights < 10.0) return std::nullopt;
    add_outline(depth, view, T, kOutlineNear, sums);

    ModelFit fit;
    fit.T_cam_obj = T;
    readings_.offered = readings_.pixel.size();
    const Matrix6d inverse = sums.information(prior).inverse();
    fit.covariance = inverse *
                     sums.gradient_covariance(
                         noise_.inflation(readings_, 1.0, 6.0), view.outline_step_px, prior
                     ) *
                     inverse;
    fit.quality.points = static_cast<int>(sums.agree);
    fit.quality.rms_steps = std::sqrt(sums.squares / sums.weights);
    const auto share = [](std::size_t part, std::size_t whole) {
        return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
    };
    fit.quality.inlier_share = share(sums.agree, sums.agree + sums.farther);
    fit.pixels = view.pixels;
    fit.proof = prove(depth, camera_.depth, scale_, view, T);
    const std::size_t unread = std::min(sums.unread, view.surface.size() * 3 / 10);
    fit.seen_share = view.inside * share(sums.agree, view.surface.size() - unread);
    fit.seen_through_share = share(sums.farther, sums.offered);
    fit.outline_share = share(sums.outline_found, sums.outline_offered);
    return fit;
}

}  // namespace kinectlab
