#include "pipeline/track/model_view.hpp"

#include <algorithm>
#include <cmath>

namespace kinectlab {
namespace {

constexpr float kNearest = 0.1F;      // m
constexpr double kLeastSlant = 0.15;  // cosine between a surface's normal and the view
constexpr int kOutlineWindow = 2;     // pixels about one of the rim that tell its direction
constexpr double kFaceInside = 3.0;   // px from the rim to where its face is asked
constexpr float kBehind = 1e4F;       // column of a vertex that is behind the camera

}  // namespace

bool ModelViewer::frame_the_object(const ObjectModel& model, const Eigen::Isometry3f& T_cam_obj) {
    drawn_.resize(model.vertices.size());
    float low_u = 1e9F, high_u = -1e9F, low_v = 1e9F, high_v = -1e9F;
    for (std::size_t i = 0; i < model.vertices.size(); ++i) {
        const Eigen::Vector3f p = T_cam_obj * model.vertices[i];
        if (!(p.z() > kNearest)) {
            drawn_[i] = {kBehind, 0.0F, 0.0F};
            continue;
        }
        const float inverse = 1.0F / p.z();
        const float u =
            static_cast<float>(camera_.fx) * p.x() * inverse + static_cast<float>(camera_.cx);
        const float v =
            static_cast<float>(camera_.fy) * p.y() * inverse + static_cast<float>(camera_.cy);
        drawn_[i] = {u, v, inverse};
        low_u = std::min(low_u, u), high_u = std::max(high_u, u);
        low_v = std::min(low_v, v), high_v = std::max(high_v, v);
    }
    // Clipped while still numbers: a vertex beside the camera may lie anywhere.
    const auto right = static_cast<float>(camera_.width - 1);
    const auto bottom = static_cast<float>(camera_.height - 1);
    if (!(high_u >= 0.0F && low_u <= right && high_v >= 0.0F && low_v <= bottom)) return false;
    const auto left = static_cast<int>(std::max(0.0F, low_u - 3.0F));
    const auto top = static_cast<int>(std::max(0.0F, low_v - 3.0F));
    const int width = static_cast<int>(std::min(right, high_u + 3.0F)) - left + 1;
    const int height = static_cast<int>(std::min(bottom, high_v + 3.0F)) - top + 1;
    const double area = static_cast<double>(width) * height;
    view_.inside = std::min(
        1.0,
        area / (static_cast<double>(high_u - low_u + 1.0F) *
                static_cast<double>(high_v - low_v + 1.0F))
    );
    const int step = std::max(
        1, static_cast<int>(std::ceil(std::sqrt(area / static_cast<double>(settings_.most_pixels))))
    );
    picture_.left = left;
    picture_.top = top;
    picture_.step = step;
    picture_.width = (width + step - 1) / step;
    picture_.height = (height + step - 1) / step;
    for (auto& p : drawn_)
        if (p.z() > 0.0F) {
            p.x() = (p.x() - static_cast<float>(left)) / static_cast<float>(step);
            p.y() = (p.y() - static_cast<float>(top)) / static_cast<float>(step);
        }
    return true;
}

void ModelViewer::draw(const ObjectModel& model) {
    const auto pixels = static_cast<std::size_t>(picture_.width * picture_.height);
    picture_.inverse.assign(pixels, 0.0F);
    picture_.triangle.resize(pixels);
    for (std::size_t t = 0; t < model.triangles.size(); ++t) {
        const auto& corners = model.triangles[t];
        const Eigen::Vector3f &a = drawn_[corners[0]], &b = drawn_[corners[1]],
                              &c = drawn_[corners[2]];
        if (a.z() == 0.0F || b.z() == 0.0F || c.z() == 0.0F) continue;
        const float area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
        if (std::abs(area) < 1e-6F) continue;
        const auto lowest = [](float x, float y, float z) {
            return std::min({x, y, z});
        };
        const auto highest = [](float x, float y, float z) {
            return std::max({x, y, z});
        };
        const auto clip = [](float x, int size) {
            return static_cast<int>(std::clamp(x, -1.0F, static_cast<float>(size)));
        };
        const int from_u =
            std::max(0, clip(std::ceil(lowest(a.x(), b.x(), c.x())), picture_.width));
        const int from_v =
            std::max(0, clip(std::ceil(lowest(a.y(), b.y(), c.y())), picture_.height));
        const int to_u = std::min(
            picture_.width - 1, clip(std::floor(highest(a.x(), b.x(), c.x())), picture_.width)
        );
        const int to_v = std::min(
            picture_.height - 1, clip(std::floor(highest(a.y(), b.y(), c.y())), picture_.height)
        );
        const float inverse_area = 1.0F / area;
        for (int v = from_v; v <= to_v; ++v) {
            for (int u = from_u; u <= to_u; ++u) {
                // Barycentric coordinates; inverse depth is linear in the picture.
                const float x = static_cast<float>(u) - a.x(), y = static_cast<float>(v) - a.y();
                const float wb = (x * (c.y() - a.y()) - y * (c.x() - a.x())) * inverse_area;
                const float wc = (y * (b.x() - a.x()) - x * (b.y() - a.y())) * inverse_area;
                if (wb < 0.0F || wc < 0.0F || wb + wc > 1.0F) continue;
                const float inverse = a.z() + wb * (b.z() - a.z()) + wc * (c.z() - a.z());
                const auto at = static_cast<std::size_t>(v * picture_.width + u);
                if (inverse <= picture_.inverse[at]) continue;
                picture_.inverse[at] = inverse;
                picture_.triangle[at] = static_cast<std::uint32_t>(t);
            }
        }
    }
}

void ModelViewer::take_surface(const ObjectModel& model, const Eigen::Isometry3d& T_cam_obj) {
    const auto covered = static_cast<std::size_t>(std::count_if(
        picture_.inverse.begin(), picture_.inverse.end(), [](float s) { return s > 0.0F; }
    ));
    view_.pixels = covered * static_cast<std::size_t>(picture_.step * picture_.step);
    if (covered == 0) return;
    const Eigen::Isometry3d T_obj_cam = T_cam_obj.inverse();
    // Going by the golden section spreads any number of points evenly along rows and across them.
    const double share =
        std::min(1.0, static_cast<double>(settings_.most_surface) / static_cast<double>(covered));
    double due = 0.5;
    for (int v = 0; v < picture_.height; ++v) {
        due = std::fmod(0.6180339887 * v, 1.0);
        for (int u = 0; u < picture_.width; ++u) {
            const auto at = static_cast<std::size_t>(v * picture_.width + u);
            if (picture_.inverse[at] <= 0.0F) continue;
            due += share;
            if (due < 1.0 || view_.surface.size() >= settings_.most_surface) continue;
            due -= 1.0;
            const Eigen::Vector3d p_cam =
                camera_.ray(picture_.left + u * picture_.step, picture_.top + v * picture_.step) /
                static_cast<double>(picture_.inverse[at]);
            Eigen::Vector3d n_obj = model.normals[picture_.triangle[at]].cast<double>();
            const double slant = n_obj.dot(T_obj_cam.linear() * p_cam.normalized());
            if (std::abs(slant) < kLeastSlant) continue;
            if (slant > 0.0) n_obj = -n_obj;
            view_.surface.push_back({T_obj_cam * p_cam, n_obj});
        }
    }
}

void ModelViewer::take_outline(const ObjectModel& model, const Eigen::Isometry3d& T_cam_obj) {
    const Eigen::Isometry3d T_obj_cam = T_cam_obj.inverse();
    const int width = picture_.width;
    const auto covers = [&](int u, int v) {
        return picture_.inverse[static_cast<std::size_t>(v * width + u)] > 0.0F;
    };
    rim_.clear();
    for (int v = kOutlineWindow; v < picture_.height - kOutlineWindow; ++v) {
        for (int u = kOutlineWindow; u < width - kOutlineWindow; ++u) {
            if (!covers(u, v) ||
                (covers(u - 1, v) && covers(u + 1, v) && covers(u, v - 1) && covers(u, v + 1)))
                continue;
            Eigen::Vector2d outwards = Eigen::Vector2d::Zero();
            for (int dv = -kOutlineWindow; dv <= kOutlineWindow; ++dv)
                for (int du = -kOutlineWindow; du <= kOutlineWindow; ++du)
                    if (!covers(u + du, v + dv)) outwards += Eigen::Vector2d(du, dv);
            if (outwards.norm() < 1.0) continue;  // thinner than the window
            outwards.normalize();
            // The rim passes between this pixel and the next.
            const Eigen::Vector2d at =
                Eigen::Vector2d(
                    picture_.left + u * picture_.step, picture_.top + v * picture_.step
                ) +
                0.5 * picture_.step * outwards;
            const auto pixel = static_cast<std::size_t>(v * width + u);
            const auto p_cam_at = [&](double x, double y, std::size_t i) -> Eigen::Vector3d {
                return camera_.ray(x, y) / static_cast<double>(picture_.inverse[i]);
            };
            // Not the sliver of a side seen edge-on that may lie along the rim.
            const int in_u = u - static_cast<int>(std::lround(kFaceInside * outwards.x()));
            const int in_v = v - static_cast<int>(std::lround(kFaceInside * outwards.y()));
            const bool is_in = in_u >= 0 && in_v >= 0 && in_u < width && in_v < picture_.height &&
                               covers(in_u, in_v);
            const int face_u = is_in ? in_u : u, face_v = is_in ? in_v : v;
            const auto face = static_cast<std::size_t>(face_v * width + face_u);
            const Eigen::Vector3d p_face = p_cam_at(
                picture_.left + face_u * picture_.step, picture_.top + face_v * picture_.step, face
            );
            Eigen::Vector3d n_face = model.normals[picture_.triangle[face]].cast<double>();
            if (n_face.dot(T_obj_cam.linear() * p_face) > 0.0) n_face = -n_face;
            rim_.push_back(
                {T_obj_cam * p_cam_at(at.x(), at.y(), pixel), T_obj_cam * p_face, n_face, outwards}
            );
        }
    }
    const std::size_t stride = rim_.size() / settings_.most_outline + 1;
    view_.outline_step_px = static_cast<double>(stride) * picture_.step;
    for (std::size_t i = 0; i < rim_.size(); i += stride)
        view_.outline.push_back(rim_[i]);
}

const ModelView& ModelViewer::look(const ObjectModel& model, const Eigen::Isometry3d& T_cam_obj) {
    view_.surface.clear();
    view_.outline.clear();
    view_.pixels = 0;
    view_.inside = 0.0;
    if (!frame_the_object(model, T_cam_obj.cast<float>())) return view_;
    draw(model);
    take_surface(model, T_cam_obj);
    if (model.has_outline && settings_.most_outline > 0) take_outline(model, T_cam_obj);
    return view_;
}

}  // namespace kinectlab
