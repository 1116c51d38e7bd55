#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/core/camera.hpp"
#include "pipeline/track/object_model.hpp"

namespace kinectlab {

/// A point of the surface that the camera sees, from the model's centre.
struct ViewPoint {
    Eigen::Vector3d p_obj;
    Eigen::Vector3d n_obj;  ///< unit, towards the camera
};

/// A point where the object ends in the picture.
struct OutlinePoint {
    Eigen::Vector3d p_obj;
    Eigen::Vector3d p_face_obj;  ///< on the face that ends there, some pixels further in
    Eigen::Vector3d n_face_obj;  ///< its normal, unit, towards the camera
    Eigen::Vector2d outwards;    ///< unit, in the picture
};

/// What the camera would see of an object at one pose.
struct ModelView {
    std::vector<ViewPoint> surface;     ///< spread evenly over the picture
    std::vector<OutlinePoint> outline;  ///< none inside the picture's border, none of a cloud
    double outline_step_px = 1.0;       ///< from one point of it to the next
    std::size_t pixels = 0;             ///< that the object covers
    double inside = 0.0;                ///< share of the box about it that lies inside the picture
};

/// Draws a model with a depth buffer and takes points of what is seen. Parts nearer than 0.1 m and
/// surfaces seen at less than 9° are left out. No allocation once warm. Not thread-safe.
class ModelViewer {
public:
    struct Settings {
        std::size_t most_surface = 1200;
        std::size_t most_outline = 160;
        std::size_t most_pixels = 10'000;  ///< drawn; of a larger object every n-th row and column
    };

    ModelViewer(const Pinhole& camera, const Settings& settings)
        : camera_(camera), settings_(settings) {}

    /// T_cam_obj of the model's centre. The view is valid until the next call; an object out of
    /// the picture gives an empty one.
    const ModelView& look(const ObjectModel& model, const Eigen::Isometry3d& T_cam_obj);

    /// The picture of the last look: inverse depths in 1/m, 0 where there is nothing.
    struct Picture {
        int left = 0, top = 0, width = 0, height = 0;
        int step = 1;  ///< pixels of the camera between two of this picture
        std::vector<float> inverse;
        std::vector<std::uint32_t> triangle;
    };
    [[nodiscard]] const Picture& picture() const { return picture_; }

private:
    bool frame_the_object(const ObjectModel& model, const Eigen::Isometry3f& T_cam_obj);
    void draw(const ObjectModel& model);
    void take_surface(const ObjectModel& model, const Eigen::Isometry3d& T_cam_obj);
    void take_outline(const ObjectModel& model, const Eigen::Isometry3d& T_cam_obj);

    Pinhole camera_;
    Settings settings_;
    Picture picture_;
    ModelView view_;
    std::vector<Eigen::Vector3f> drawn_;  // column, row, inverse depth of each vertex
    std::vector<OutlinePoint> rim_;
};

}  // namespace kinectlab
