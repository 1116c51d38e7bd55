#include <cmath>

#include "pipeline/track/shape_detect.hpp"
#include "pipeline/track/sphere_candidate.hpp"
#include "pipeline/track/sphere_fit.hpp"
#include "tests/bench/measurements.hpp"
#include "tests/bench/peer_shapes.hpp"
#include "tests/bench/shape_bound.hpp"
#include "tests/bench/swing_frames.hpp"

namespace kinectlab::bench {
namespace {

constexpr int kFrames = 60;
constexpr int kStockFrames = 8;

/// Sums of squared errors of a shape against the true solid.
struct Errors {
    double place2 = 0.0, axis2 = 0.0, size2 = 0.0, ms = 0.0;
    int frames = 0;

    void add(const Shape& shape, const test::Solid& truth) {
        const bool can = truth.kind == test::Solid::Kind::can;
        const double middle = can ? 0.5 * (truth.from + truth.to) : 0.0;
        const Eigen::Vector3d reference = truth.place + middle * truth.axis;
        Eigen::Vector3d off = shape.point - reference;
        if (can) {  // the found axis where it passes the true middle
            const double h = -off.dot(truth.axis) / shape.axis.dot(truth.axis);
            off = shape.point + h * shape.axis - reference;
        }
        place2 += off.squaredNorm();
        axis2 += shape.axis.cross(truth.axis).squaredNorm();
        const bool cone = truth.kind == test::Solid::Kind::cone;
        size2 += std::pow(shape.size - (cone ? truth.angle : truth.radius), 2);
        ++frames;
    }
    [[nodiscard]] double rms(double squares) const { return std::sqrt(squares / frames); }
};

struct Region {
    const char* name;
    ShapeKind kind;
    test::Solid solid;
    double times_faster;
    double times_bound;
};

/// The sphere's own tracker; the radius is free, as the peer has it.
std::optional<Shape> find_sphere(
    SphereFitter& fitter, const RgbdCamera& camera, const RgbdFrame& frame, MovedPixels pixels
) {
    const DisparityScale scale(camera);
    const SurfaceSample sample(frame.depth, pixels, camera.depth, scale);
    const auto guess = sphere_candidate(sample.points(), SphereSettings{}, scale);
    if (!guess) return std::nullopt;
    const auto fit = fitter.fit(frame.depth, *guess, false);
    if (!fit) return std::nullopt;
    return Shape{
        ShapeKind::sphere, fit->sphere.centre_cam, Eigen::Vector3d::UnitZ(), fit->sphere.radius};
}

void measure(const Region& region, Figures& figures) {
    test::ShapeRoom room(11);
    room.solids = {region.solid, test::wall({0, 0, 2.5}, {0, 0, -1})};
    SegmentShapes shapes(room.camera);
    SphereFitter sphere(room.camera);
    DisparityImage image(room.camera);
    ShapeTarget target{0, region.kind};
    if (region.kind == ShapeKind::cone) target.limits = {{}, kLeastConeAngle, kMostConeAngle};
    Errors ours, stock;
    double normals_ms = 0.0;
    std::vector<std::uint32_t> pixels;
    for (int i = 0; i < kFrames; ++i) {
        const RgbdFrame frame = room.frame();
        if (pixels.empty()) pixels = room.pixels_of(0);
        const auto find = [&]() -> std::optional<Shape> {
            if (region.kind == ShapeKind::sphere)
                return find_sphere(sphere, room.camera, frame, pixels);
            image.load_around(frame.depth, pixels);
            const auto fit = shapes.in_segment(image, pixels, target);
            return fit ? std::optional(fit->shape) : std::nullopt;
        };
        if (i == 0) (void)find();  // buffers grow once in a recording
        const double start = thread_seconds();
        const auto found = find();
        ours.ms += 1e3 * (thread_seconds() - start);
        if (found) ours.add(*found, region.solid);
        if (i >= kStockFrames) continue;
        const StockShape peer = stock_shape(room.camera, frame, pixels, region.kind);
        stock.ms += peer.segmentation_ms;
        normals_ms += peer.normals_ms;
        if (peer.shape) stock.add(*peer.shape, region.solid);
    }
    const ShapeBound bound = shape_bound(room.camera, region.solid);
    const double our_ms = ours.ms / kFrames, stock_ms = stock.ms / kStockFrames;
    const std::string name = std::string(region.name) + ", region of interest";
    const auto add = [&](const std::string& what,
                         double value,
                         const char* unit,
                         std::optional<double> limit,
                         std::optional<double> peer,
                         Better better = Better::lower) {
        figures.push_back({name + what, value, unit, limit, better, peer, peer ? "PCL" : ""});
    };
    add(", normals included", our_ms, "ms", stock_ms / region.times_faster, stock_ms);
    // The peer cannot run without normals, which we find in our time.
    const double chain_ms = stock_ms + normals_ms / kStockFrames;
    add(", the peer's normals included too", our_ms, "ms", {}, chain_ms);
    add(": found",
        static_cast<double>(ours.frames) / kFrames,
        "1",
        1.0,
        static_cast<double>(stock.frames) / kStockFrames,
        Better::higher);
    add(": place, RMS over Cramér-Rao",
        ours.rms(ours.place2) / bound.place_m,
        "1",
        region.times_bound,
        stock.rms(stock.place2) / bound.place_m);
    if (region.kind != ShapeKind::sphere)
        add(": axis, RMS over Cramér-Rao",
            ours.rms(ours.axis2) / bound.axis_rad,
            "1",
            region.times_bound,
            stock.rms(stock.axis2) / bound.axis_rad);
    add(region.kind == ShapeKind::cone ? ": angle, RMS over Cramér-Rao"
                                       : ": radius, RMS over Cramér-Rao",
        ours.rms(ours.size2) / bound.size,
        "1",
        region.times_bound,
        stock.rms(stock.size2) / bound.size);
    add(": place, RMS", 1e3 * ours.rms(ours.place2), "mm", {}, 1e3 * stock.rms(stock.place2));
}

}  // namespace

Figures measure_shape_regions() {
    Figures figures;
    measure(
        {"sphere", ShapeKind::sphere, test::ball({0.05, 0.05, 1.2}, 0.06), 10.0, 1.15}, figures
    );
    measure(
        {"cylinder",
         ShapeKind::cylinder,
         test::can({0.05, 0.1, 1.2}, Eigen::Vector3d(0.15, -1.0, -0.35), 0.04, 0.18),
         20.0,
         1.3},
        figures
    );
    measure(
        {"cone",
         ShapeKind::cone,
         test::cone({0.0, -0.1, 1.2}, Eigen::Vector3d(0.1, 1.0, 0.3), 0.35, 0.03, 0.22),
         20.0,
         1.3},
        figures
    );
    return figures;
}

}  // namespace kinectlab::bench
