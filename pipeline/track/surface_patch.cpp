#include "pipeline/track/surface_patch.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "pipeline/core/number_text.hpp"
#include "pipeline/track/model_fit.hpp"
#include "pipeline/track/patch_recognition.hpp"

namespace kinectlab {
namespace {

constexpr TimeNs kMemory = kNsPerSecond / 2;  // a place older than this says nothing
constexpr double kOrientationSigma = 0.2;     // rad: less sure than this is not seen
constexpr double kCertainTurn = 0.01;         // rad: a mesh's facets do not make it this sure
constexpr double kTryTurn = 0.2;              // rad
constexpr int kLongestRest = 31;              // frames, while nothing moves
constexpr int kLongestPause = 7;              // frames

/// What keeps an object that was seen a moment ago: less than it takes to recognise one.
constexpr Acceptance kFollowed{0.25, 0.65, 0.2, 4.0, 0.25, 0.18};

struct Target {
    TrackedObject<SurfacePatchSettings> object;
    std::shared_ptr<const ObjectModel> model;
    std::unique_ptr<PatchRecogniser> recogniser;
    std::optional<ModelFit> last;
    TimeNs seen_at = 0;
    bool is_new = false;  ///< recognised, not followed yet: how it moves is not known
    int pause = 0;        ///< frames in which it is only looked for in what moved
    int last_pause = 0;   ///< frames
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
    Eigen::Vector3d turning = Eigen::Vector3d::Zero();   ///< rad/s, camera frame
};

bool shows_orientation(const Matrix6d& covariance) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(
        covariance.bottomRightCorner<3, 3>(), Eigen::EigenvaluesOnly
    );
    return solved.eigenvalues()[2] < kOrientationSigma * kOrientationSigma;
}

Eigen::Isometry3d predicted(const Target& target, TimeNs t) {
    const double dt = static_cast<double>(t - target.seen_at) / static_cast<double>(kNsPerSecond);
    Eigen::Isometry3d T = target.last->T_cam_obj;
    const double angle = target.turning.norm() * dt;
    if (angle > 1e-9)
        T.linear() = Eigen::AngleAxisd(angle, target.turning.normalized()) * T.linear();
    T.translation() += target.velocity * dt;
    return T;
}

void remember(Target& target, const ModelFit& fit, TimeNs t) {
    target.velocity.setZero();
    target.turning.setZero();
    const double dt = static_cast<double>(t - target.seen_at) / static_cast<double>(kNsPerSecond);
    if (target.last && dt > 0.0) {
        const auto& before = target.last->T_cam_obj;
        target.velocity = (fit.T_cam_obj.translation() - before.translation()) / dt;
        const Eigen::AngleAxisd turned(fit.T_cam_obj.linear() * before.linear().transpose());
        // What is not seen must not go on turning by itself.
        if (shows_orientation(fit.covariance)) target.turning = turned.angle() / dt * turned.axis();
    }
    target.last = fit;
    target.seen_at = t;
}

/// From the model's centre to the origin of its own frame, p = c - R centre_obj.
TrackSample sample_of(const Target& target, const ModelFit& fit, TimeNs t) {
    TrackSample sample;
    sample.t = t;
    sample.object = target.object.index;
    sample.status = TrackStatus::tracked;
    const Eigen::Matrix3d& R = fit.T_cam_obj.linear();
    const Eigen::Vector3d arm = R * target.model->centre_obj;
    sample.p_cam = fit.T_cam_obj.translation() - arm;
    sample.has_orientation = shows_orientation(fit.covariance);
    if (sample.has_orientation) sample.q_cam_obj = Eigen::Quaterniond(R).normalized();
    Matrix6d move = Matrix6d::Identity();
    move.topRightCorner<3, 3>() << 0.0, -arm.z(), arm.y(), arm.z(), 0.0, -arm.x(), -arm.y(),
        arm.x(), 0.0;
    sample.covariance = move * fit.covariance * move.transpose();
    sample.quality = fit.quality;
    return sample;
}

class SurfacePatchTracker : public Tracker {
public:
    SurfacePatchTracker(const RgbdCamera& camera, std::vector<Target> targets)
        : camera_(camera),
          targets_(std::move(targets)),
          fitter_(camera),
          trial_(camera),
          viewer_(camera.depth, {0, 0, 1'000'000}) {}

    void track(
        const RgbdFrame& frame,
        std::span<const MovedPixels> moved,
        std::vector<TrackSample>& samples
    ) override {
        fits_.assign(targets_.size(), std::nullopt);
        for (std::size_t i = 0; i < targets_.size(); ++i)
            fits_[i] = follow(targets_[i], frame);
        recognise_lost(frame, moved);
        for (std::size_t i = 0; i < targets_.size(); ++i) {
            if (fits_[i]) {
                own_up_to_symmetry(*targets_[i].model, frame, *fits_[i]);
                remember(targets_[i], *fits_[i], frame.t);
                samples.push_back(sample_of(targets_[i], *fits_[i], frame.t));
                continue;
            }
            TrackSample lost;
            lost.t = frame.t;
            lost.object = targets_[i].object.index;
            lost.quality.why_lost = "nothing in view fits its model";
            samples.push_back(lost);
        }
    }

    void reset() override {
        for (auto& target : targets_) {
            target.last.reset();
            target.pause = target.last_pause = 0;
        }
    }

private:
    std::optional<ModelFit> follow(Target& target, const RgbdFrame& frame) {
        if (target.last && frame.t - target.seen_at > kMemory) target.last.reset();
        if (!target.last) return std::nullopt;
        auto fit = accepted(target, frame, predicted(target, frame.t));
        const bool moved = !target.velocity.isZero() || !target.turning.isZero();
        if (!fit && moved) fit = accepted(target, frame, target.last->T_cam_obj);
        target.is_new = false;
        return fit;
    }

    std::optional<ModelFit> accepted(
        const Target& target, const RgbdFrame& frame, const Eigen::Isometry3d& T_start
    ) {
        auto fit = fitter_.fit(frame.depth, *target.model, T_start, {});
        const Acceptance limits = target.is_new ? Acceptance{} : kFollowed;
        if (fit && !is_accepted(*fit, *target.model, camera_, limits)) fit.reset();
        return fit;
    }

    /// A mesh has facets even where the thing is round, and they hold on to a turn that nothing
    /// shows. So an uncertain turn has to prove itself: turned by more than a facet, the object
    /// must fit worse or find its way back.
    void own_up_to_symmetry(const ObjectModel& model, const RgbdFrame& frame, ModelFit& fit) {
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> turns(
            Eigen::Matrix3d(fit.covariance.bottomRightCorner<3, 3>())
        );
        const double sigma = std::sqrt(turns.eigenvalues()[2]);
        if (sigma < kCertainTurn || sigma > kOrientationSigma) return;
        const Eigen::Vector3d axis = turns.eigenvectors().col(2);
        for (const double angle : {kTryTurn, -kTryTurn}) {
            Eigen::Isometry3d start = fit.T_cam_obj;
            start.linear() = Eigen::AngleAxisd(angle, axis) * start.linear();
            const auto other = trial_.fit(frame.depth, model, start, {});
            if (!other) return;
            const Eigen::AngleAxisd left(
                other->T_cam_obj.linear() * fit.T_cam_obj.linear().transpose()
            );
            const bool worse = other->quality.rms_steps > 1.1 * fit.quality.rms_steps ||
                               other->seen_share < 0.95 * fit.seen_share ||
                               other->outline_share < 0.9 * fit.outline_share;
            if (left.angle() < 0.5 * kTryTurn || worse) return;
        }
        fit.covariance.bottomRightCorner<3, 3>() += axis * axis.transpose();
    }

    /// What others were found in is taken out, so that two of a kind are two.
    void recognise_lost(const RgbdFrame& frame, std::span<const MovedPixels> moved) {
        const auto is_lost = [](const auto& fit) {
            return !fit;
        };
        if (std::none_of(fits_.begin(), fits_.end(), is_lost)) return;
        rest_ = frame.depth;
        for (std::size_t i = 0; i < targets_.size(); ++i)
            if (fits_[i]) take_out(*targets_[i].model, fits_[i]->T_cam_obj);
        for (std::size_t i = 0; i < targets_.size(); ++i) {
            if (fits_[i]) continue;
            fits_[i] = recognised(targets_[i], moved);
            if (!fits_[i]) continue;
            targets_[i].is_new = true;
            targets_[i].last.reset();  // no velocity from where it was lost to here
            take_out(*targets_[i].model, fits_[i]->T_cam_obj);
        }
    }

    /// What is not there must not cost a search of the whole picture in each frame.
    std::optional<ModelFit> recognised(Target& target, std::span<const MovedPixels> moved) {
        auto fit = target.recogniser->find_moved(rest_, moved);
        if (!fit && target.pause > 0) {
            --target.pause;
            return std::nullopt;
        }
        if (!fit) fit = target.recogniser->find(rest_, moved);
        const int longest = moved.empty() ? kLongestRest : kLongestPause;
        target.last_pause = fit ? 0 : std::min(longest, 2 * target.last_pause + 1);
        target.pause = target.last_pause;
        return fit;
    }

    void take_out(const ObjectModel& model, const Eigen::Isometry3d& T_cam_obj) {
        viewer_.look(model, T_cam_obj);
        const auto& seen = viewer_.picture();
        const auto width = static_cast<std::size_t>(camera_.depth.width);
        for (int v = 0; v < seen.height; ++v)
            for (int u = 0; u < seen.width; ++u)
                if (seen.inverse[static_cast<std::size_t>(v * seen.width + u)] > 0.0F)
                    rest_
                        [static_cast<std::size_t>(seen.top + v) * width +
                         static_cast<std::size_t>(seen.left + u)] = 0;
    }

    RgbdCamera camera_;
    std::vector<Target> targets_;
    ModelFitter fitter_;
    ModelFitter trial_;  // of poses that are wrong: their noise is not to be learned
    ModelViewer viewer_;
    std::vector<std::optional<ModelFit>> fits_;
    std::vector<std::uint16_t> rest_;
};

}  // namespace

Result<void> check(const SurfacePatchSettings& settings, const std::string& path) {
    if (!settings.mesh)
        return fail(
            ErrorCode::invalid_argument,
            path + ".model",
            "was not loaded from \"" + settings.model + "\"",
            "give a .ply, .obj, .stl or .pcd file"
        );
    if (std::isfinite(settings.model_unit_m) && settings.model_unit_m > 0.0) return {};
    return fail(
        ErrorCode::invalid_argument,
        path + ".model_unit_m",
        "is " + number_text(settings.model_unit_m),
        "give metres for each unit of the model, above 0, e.g. 0.001 for millimetres"
    );
}

Result<std::unique_ptr<Tracker>> make_surface_patch_tracker(
    const RgbdCamera& camera, TrackedObjects<SurfacePatchSettings> objects
) {
    std::vector<Target> targets;
    for (auto& object : objects) {
        const auto wrong = [&](Error error) {
            error.field = object.name + ": " + object.settings.model;
            return tl::unexpected<Error>(std::move(error));
        };
        auto model = make_object_model(*object.settings.mesh, object.settings.model_unit_m);
        if (!model) return wrong(model.error());
        Target target;
        target.model = std::make_shared<const ObjectModel>(std::move(*model));
        target.recogniser =
            std::make_unique<PatchRecogniser>(camera, target.model, object.settings.seed);
        if (target.recogniser->model_patches() == 0)
            return wrong(
                {ErrorCode::invalid_argument,
                 {},
                 "has no place where its surface bends in a way of its own",
                 "track it by a shape: sphere, plane, cylinder or cone; is model_unit_m right?"}
            );
        target.object = std::move(object);
        targets.push_back(std::move(target));
    }
    return std::make_unique<SurfacePatchTracker>(camera, std::move(targets));
}

}  // namespace kinectlab
