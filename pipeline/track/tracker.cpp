#include "pipeline/track/tracker.hpp"

#include <algorithm>
#include <set>

#include "pipeline/track/carrying_plane.hpp"
#include "pipeline/track/change.hpp"
#include "pipeline/track/colour.hpp"
#include "pipeline/track/shape_tracker.hpp"
#include "pipeline/track/sift3d.hpp"
#include "pipeline/track/sphere.hpp"
#include "pipeline/track/surface_patch.hpp"
#include "pipeline/track/texture.hpp"

namespace kinectlab {
namespace {

std::string path_of(std::size_t i) {
    return "objects[" + std::to_string(i) + "]";
}

Result<void> check_names(std::span<const ObjectSpec> objects) {
    if (objects.empty())
        return fail(
            ErrorCode::invalid_argument, "objects", "is empty", "name at least one object to track"
        );
    std::set<std::string> names;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (objects[i].name.empty())
            return fail(
                ErrorCode::invalid_argument,
                path_of(i) + ".name",
                "is empty",
                "give the object a name"
            );
        if (!names.insert(objects[i].name).second)
            return fail(
                ErrorCode::invalid_argument,
                path_of(i) + ".name",
                "\"" + objects[i].name + "\" is there twice",
                "give every object its own name"
            );
    }
    return {};
}

/// A method whose settings mean places in the picture is asked with the camera too.
Result<void> check_settings(const RgbdCamera& camera, std::span<const ObjectSpec> objects) {
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const auto checked = std::visit(
            [&](const auto& settings) {
                if constexpr (requires { check(settings, camera, path_of(i)); })
                    return check(settings, camera, path_of(i));
                else
                    return check(settings, path_of(i));
            },
            objects[i].settings
        );
        if (!checked) return checked;
    }
    return {};
}

/// The objects of one method; none if it is not in use.
template <class Settings>
TrackedObjects<Settings> own(std::span<const ObjectSpec> objects) {
    TrackedObjects<Settings> own;
    for (std::size_t i = 0; i < objects.size(); ++i)
        if (const auto* settings = std::get_if<Settings>(&objects[i].settings))
            own.push_back({static_cast<std::uint32_t>(i), objects[i].name, *settings});
    return own;
}

}  // namespace

Result<std::vector<std::unique_ptr<Tracker>>> make_trackers(
    const RgbdCamera& camera, std::span<const ObjectSpec> objects
) {
    if (auto ok = check_names(objects); !ok) return tl::unexpected(ok.error());
    if (auto ok = check_settings(camera, objects); !ok) return tl::unexpected(ok.error());
    if (auto ok = check_carrying_planes(objects); !ok) return tl::unexpected(ok.error());
    std::vector<std::unique_ptr<Tracker>> trackers;
    Result<void> all_made;
    const auto add = [&](auto own, auto make) {
        if (own.empty() || !all_made) return;
        // A method that needs a model may find fault with it.
        Result<std::unique_ptr<Tracker>> made = make(camera, std::move(own));
        if (made)
            trackers.push_back(std::move(*made));
        else
            all_made = tl::unexpected(made.error());
    };
    auto balls = own<SphereSettings>(objects);
    std::erase_if(balls, [](const auto& ball) { return !is_for_sphere_tracker(ball.settings); });
    add(std::move(balls), make_sphere_tracker);
    add(shape_targets(objects), make_shape_tracker);  // one for all, which searches a scene once
    add(own<ChangeTrackSettings>(objects), make_change_tracker);
    add(own<SurfacePatchSettings>(objects), make_surface_patch_tracker);
    add(own<ColourSettings>(objects), make_colour_tracker);
    add(own<TextureSettings>(objects), make_texture_tracker);
    add(own<Sift3dTrackSettings>(objects), make_sift3d_tracker);
    if (!all_made) return tl::unexpected(all_made.error());
    // Last: it goes by where the others found the balls.
    if (std::any_of(objects.begin(), objects.end(), is_carrying))
        trackers.push_back(make_carrying_plane_tracker(camera, objects));
    return trackers;
}

}  // namespace kinectlab
