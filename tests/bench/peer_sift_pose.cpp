#include "tests/bench/peer_sift_pose.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/features/two_cameras.hpp"

namespace kinectlab::bench {
namespace {

struct Spots {
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat descriptors;
};

constexpr double kSearchMargin_px = 48.0;  // as the project's tracker has

/// Of a part of the picture; the spots' places are those in the whole.
Spots spots_of(const RgbdCamera& camera, const RgbdFrame& frame, const cv::Rect& part) {
    cv::setNumThreads(1);
    const cv::Mat rgb(
        camera.colour.height,
        camera.colour.width,
        CV_8UC3,
        const_cast<std::uint8_t*>(frame.rgb.data())  // read only, but Mat has no const data
    );
    cv::Mat grey;
    cv::cvtColor(rgb(part), grey, cv::COLOR_RGB2GRAY);
    static const cv::Ptr<cv::SIFT> sift = cv::SIFT::create();
    Spots spots;
    sift->detectAndCompute(grey, cv::noArray(), spots.keypoints, spots.descriptors);
    for (auto& keypoint : spots.keypoints)
        keypoint.pt += cv::Point2f(part.tl());
    return spots;
}

cv::Rect whole(const RgbdCamera& camera) {
    return {0, 0, camera.colour.width, camera.colour.height};
}

}  // namespace

std::vector<Keypoint2d> opencv_sift(const RgbdCamera& camera, const RgbdFrame& frame) {
    std::vector<Keypoint2d> keypoints;
    for (const auto& found : spots_of(camera, frame, whole(camera)).keypoints) {
        Keypoint2d keypoint;
        keypoint.u = found.pt.x;
        keypoint.v = found.pt.y;
        keypoint.scale_px = 0.5F * found.size;
        keypoint.response = found.response;
        keypoints.push_back(keypoint);
    }
    return keypoints;
}

struct OpenCvSiftPose::State {
    RgbdCamera camera;
    std::vector<cv::Point3f> points;  // colour camera's frame, as seen first
    cv::Mat descriptors;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // of the points
    double radius_m = 0.0;                             // of them around it
    std::optional<Eigen::Vector3d> place;              // where the origin was last

    /// The project's tracker's own rule: the object's size around its last place, and a margin.
    [[nodiscard]] cv::Rect where_to_look() const {
        if (!place) return whole(camera);
        const Eigen::Vector2d middle = camera.colour.project(*place);
        const double reach = radius_m / place->z() * camera.colour.fx + kSearchMargin_px;
        const cv::Point2d corner(reach, reach), at(middle.x(), middle.y());
        return cv::Rect(cv::Point(at - corner), cv::Point(at + corner)) & whole(camera);
    }
};

OpenCvSiftPose::OpenCvSiftPose(
    const RgbdCamera& camera, const RgbdFrame& first, int left, int top, int width, int height
)
    : state_(std::make_unique<State>()) {
    state_->camera = camera;
    const TwoCameras cameras(camera);
    const Spots spots = spots_of(camera, first, whole(camera));
    for (std::size_t i = 0; i < spots.keypoints.size(); ++i) {
        const auto& at = spots.keypoints[i].pt;
        if (at.x < left || at.y < top || at.x >= left + width || at.y >= top + height) continue;
        const auto traced = cameras.trace(first.depth, at.x, at.y);
        if (!traced) continue;
        const Eigen::Vector3f p = (camera.T_colour_depth * traced->p_cam).cast<float>();
        state_->points.emplace_back(p.x(), p.y(), p.z());
        state_->descriptors.push_back(spots.descriptors.row(static_cast<int>(i)));
        state_->origin += p.cast<double>();
    }
    if (state_->points.empty()) return;
    state_->origin /= static_cast<double>(state_->points.size());
    for (const auto& p : state_->points)
        state_->radius_m =
            std::max(state_->radius_m, (Eigen::Vector3d(p.x, p.y, p.z) - state_->origin).norm());
    state_->place = state_->origin;
}

OpenCvSiftPose::~OpenCvSiftPose() = default;

void OpenCvSiftPose::forget_place() {
    state_->place.reset();
}

std::optional<Eigen::Isometry3d> OpenCvSiftPose::motion(const RgbdFrame& frame) {
    const Spots spots = spots_of(state_->camera, frame, state_->where_to_look());
    if (spots.keypoints.size() < 2 || state_->points.empty()) return std::nullopt;
    std::vector<std::vector<cv::DMatch>> matches;
    cv::BFMatcher(cv::NORM_L2).knnMatch(state_->descriptors, spots.descriptors, matches, 2);
    std::vector<cv::Point3f> object;
    std::vector<cv::Point2f> image;
    for (const auto& match : matches) {
        if (match.size() < 2 || match[0].distance > 0.8F * match[1].distance) continue;
        object.push_back(state_->points[static_cast<std::size_t>(match[0].queryIdx)]);
        image.push_back(spots.keypoints[static_cast<std::size_t>(match[0].trainIdx)].pt);
    }
    if (object.size() < 6) return std::nullopt;
    const Pinhole& k = state_->camera.colour;
    const cv::Matx33d intrinsics(k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1);
    cv::Mat turn, shift, inliers;
    if (!cv::solvePnPRansac(
            object, image, intrinsics, cv::noArray(), turn, shift, false, 200, 2.0F, 0.99, inliers
        ) ||
        inliers.rows < 6)
        return std::nullopt;
    cv::Mat R;
    cv::Rodrigues(turn, R);
    Eigen::Isometry3d motion_colour = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            motion_colour.linear()(i, j) = R.at<double>(i, j);
        motion_colour.translation()[i] = shift.at<double>(i);
    }
    state_->place = motion_colour * state_->origin;
    const Eigen::Isometry3d& T = state_->camera.T_colour_depth;
    return T.inverse() * motion_colour * T;
}

}  // namespace kinectlab::bench
