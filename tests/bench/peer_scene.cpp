#include "tests/bench/peer_scene.hpp"

#ifdef KINECTLAB_CGAL

#include <tuple>

#include <CGAL/Shape_detection/Efficient_RANSAC.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>

#include "tests/bench/swing_frames.hpp"

namespace kinectlab::bench {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Oriented = std::tuple<Kernel::Point_3, Kernel::Vector_3, std::uint32_t>;  // and its pixel
using Points = std::vector<Oriented>;
using Traits = CGAL::Shape_detection::Efficient_RANSAC_traits<
    Kernel,
    Points,
    CGAL::Nth_of_tuple_property_map<0, Oriented>,
    CGAL::Nth_of_tuple_property_map<1, Oriented>>;
using Ransac = CGAL::Shape_detection::Efficient_RANSAC<Traits>;

template <class V>
Eigen::Vector3d vector(const V& v) {
    return {v.x(), v.y(), v.z()};
}

std::optional<Shape> shape_from(const Ransac::Shape* found) {
    namespace sd = CGAL::Shape_detection;
    if (const auto* plane = dynamic_cast<const sd::Plane<Traits>*>(found)) {
        const Eigen::Vector3d n = vector(plane->plane_normal()).normalized();
        const auto p = static_cast<Kernel::Plane_3>(*plane).point();
        return Shape{ShapeKind::plane, vector(p), n, 0.0};
    }
    if (const auto* ball = dynamic_cast<const sd::Sphere<Traits>*>(found))
        return Shape{
            ShapeKind::sphere, vector(ball->center()), Eigen::Vector3d::UnitZ(), ball->radius()};
    if (const auto* can = dynamic_cast<const sd::Cylinder<Traits>*>(found))
        return Shape{
            ShapeKind::cylinder,
            vector(can->axis().point(0)),
            vector(can->axis().to_vector()).normalized(),
            can->radius()};
    if (const auto* cone = dynamic_cast<const sd::Cone<Traits>*>(found))
        return Shape{
            ShapeKind::cone,
            vector(cone->apex()),
            vector(cone->axis()).normalized(),
            cone->angle()};
    return std::nullopt;
}

}  // namespace

std::optional<StockScene> stock_scene(const SurfacePoints& points) {
    Points cloud;
    cloud.reserve(points.size);
    for (std::size_t i = 0; i < points.size; ++i)
        cloud.emplace_back(
            Kernel::Point_3(points.px[i], points.py[i], points.pz[i]),
            Kernel::Vector_3(points.nx[i], points.ny[i], points.nz[i]),
            points.pixel[i]
        );
    StockScene scene;
    const double start = thread_seconds();
    Ransac ransac;
    ransac.set_input(cloud);
    ransac.add_shape_factory<CGAL::Shape_detection::Plane<Traits>>();
    ransac.add_shape_factory<CGAL::Shape_detection::Sphere<Traits>>();
    ransac.add_shape_factory<CGAL::Shape_detection::Cylinder<Traits>>();
    ransac.add_shape_factory<CGAL::Shape_detection::Cone<Traits>>();
    Ransac::Parameters parameters;
    parameters.probability = 0.01;
    parameters.min_points = 500;
    parameters.epsilon = 0.01;
    parameters.cluster_epsilon = 0.02;
    parameters.normal_threshold = 0.906;
    ransac.detect(parameters);
    scene.ms = 1e3 * (thread_seconds() - start);
    for (const auto& found : ransac.shapes()) {
        const auto shape = shape_from(found.get());
        if (!shape) continue;
        StockScene::Found one{*shape, {}};
        for (const auto i : found->indices_of_assigned_points())
            one.pixels.push_back(std::get<2>(cloud[i]));  // CGAL puts its input in another order
        scene.shapes.push_back(std::move(one));
    }
    return scene;
}

}  // namespace kinectlab::bench

#else

namespace kinectlab::bench {

std::optional<StockScene> stock_scene(const SurfacePoints&) {
    return std::nullopt;
}

}  // namespace kinectlab::bench

#endif
