#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/track/assignment.hpp"
#include "pipeline/track/predicted_point.hpp"
#include "pipeline/track/surface_moments.hpp"
#include "pipeline/track/tracker.hpp"

namespace kinectlab {

/// One thing that moves, in one frame.
struct Thing {
    std::uint32_t identity = 0;  ///< 1, 2, … in the order in which things came, biggest first
    bool seen = false;           ///< in this frame
    SurfaceMoments now;          ///< if seen
    double hidden_u = 0.0;       ///< m: how far what could not be seen may have moved the centroid
    PredictedPoint place;
    double area_m2 = 0.0;   ///< when seen whole
    double extent_m = 0.0;  ///< when seen whole
};

/// Splits what moved into separate things that keep their identity over time.
///   - A segment belongs to the thing that was to be expected there: constant velocity, the most
///   likely
///     assignment of all (Bar-Shalom & Fortmann 1988), size as well as place.
///   - Things that touch make one segment; each of its pixels goes to the thing whose expected
///     place is nearest in units of the thing's size.
///   - What stands before a thing cuts it into pieces; pieces that make no more than the whole are
///   joined.
///   - A thing that is not seen keeps its identity for memory_s, and takes it up again where it
///   turns up:
///     behind another, or in its own place in the reference, it is a gap and not an end.
/// No allocation after the constructor. Not thread-safe.
class Identities {
public:
    Identities(const RgbdCamera& camera, double memory_s);

    /// In the order of identities; valid until the next call. Frames in the order of time.
    [[nodiscard]] std::span<const Thing> follow(
        const RgbdFrame& frame, std::span<const MovedPixels> moved
    );

    /// Whose a segment of the last call is as a whole: its place in what that returned; none where
    /// things share it or nobody has it.
    [[nodiscard]] std::optional<std::size_t> owner_of(std::size_t segment) const;

    /// Forgets all things; the next is number 1 again.
    void reset();

    static constexpr std::size_t kMostThings = 64;

private:
    struct Part {
        SurfaceMoments moments;
        int owner = Assignment::kNone;
        double shared_u = 0.0;
    };
    void describe(const RgbdFrame& frame, std::span<const MovedPixels> moved);
    void forget(TimeNs t);
    void match(TimeNs t);
    void share(const RgbdFrame& frame, std::span<const MovedPixels> moved);
    void join_pieces(TimeNs t);
    void begin_new(TimeNs t);
    [[nodiscard]] std::optional<std::size_t> place_for_new();
    void see(TimeNs t);
    [[nodiscard]] double spread2(const Thing& thing, TimeNs t) const;
    [[nodiscard]] bool reaches(
        const Thing& thing, const RgbdFrame& frame, MovedPixels pixels, double& distance
    ) const;
    void claim(std::size_t part, const RgbdFrame& frame, MovedPixels pixels);
    void divide(std::size_t part, const RgbdFrame& frame, MovedPixels pixels);

    SurfacePoints surface_;
    TimeNs memory_;
    TimeNs last_ = 0;
    std::uint32_t next_identity_ = 1;
    std::vector<Thing> things_;
    std::vector<Part> parts_;
    std::vector<double> cost_;
    std::vector<std::size_t> claimants_;
    std::vector<Eigen::Vector3d> centres_;
    std::vector<SurfaceMoments> shares_;
    std::vector<unsigned char> taken_;
    Assignment assignment_;
};

}  // namespace kinectlab
