#include "pipeline/track/change.hpp"

#include <cmath>

#include "pipeline/core/disparity.hpp"

namespace kinectlab {
namespace {

class ChangeTracker : public Tracker {
public:
    ChangeTracker(const RgbdCamera& camera, TrackedObjects<ChangeTrackSettings> objects)
        : camera_(camera), scale_(camera), objects_(std::move(objects)) {}

    void track(
        const RgbdFrame& frame,
        std::span<const MovedPixels> moved,
        std::vector<TrackSample>& samples
    ) override {
        for (const auto& object : objects_)
            for (const auto& pixels : moved)
                samples.push_back(centroid(frame, pixels, object.index));
    }

    void reset() override {}

private:
    [[nodiscard]] TrackSample centroid(
        const RgbdFrame& frame, MovedPixels pixels, std::uint32_t object
    ) const {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
        for (const auto pixel : pixels) {
            const auto column = static_cast<int>(pixel) % camera_.depth.width;
            const auto row = static_cast<int>(pixel) / camera_.depth.width;
            const double s = scale_.steps(frame.depth[pixel]);
            const double z = scale_.metres(s);
            const Eigen::Vector3d ray = camera_.depth.ray(column, row);
            sum += z * ray;
            const double sigma_z = z * scale_.sigma_at(s) / s;
            noise += sigma_z * sigma_z * ray * ray.transpose();
        }
        const auto n = static_cast<double>(pixels.size());
        TrackSample sample;
        sample.t = frame.t;
        sample.object = object;
        sample.status = TrackStatus::tracked;
        sample.p_cam = sum / n;
        const double outline = 0.5 * sample.p_cam.z() / camera_.depth.fx;
        sample.covariance.topLeftCorner<3, 3>() = noise / (n * n);
        sample.covariance.diagonal().head<2>().array() += outline * outline / std::sqrt(n);
        sample.quality = {static_cast<int>(pixels.size()), 1.0, 0.0};
        return sample;
    }

    RgbdCamera camera_;
    DisparityScale scale_;
    TrackedObjects<ChangeTrackSettings> objects_;
};

}  // namespace

std::unique_ptr<Tracker> make_change_tracker(
    const RgbdCamera& camera, TrackedObjects<ChangeTrackSettings> objects
) {
    return std::make_unique<ChangeTracker>(camera, std::move(objects));
}

}  // namespace kinectlab
