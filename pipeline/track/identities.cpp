#include "pipeline/track/identities.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinectlab {
namespace {

constexpr double kGate = 16.0;         // squared distance in units of its variance: 4 σ
constexpr double kNoneCost = 80.0;     // dearer than any place within the gate
constexpr double kMostSpread = 0.4;    // m: a thing long unseen is not looked for everywhere
constexpr double kUnitSpread = 0.01;   // m, of the likelihood
constexpr double kLogAreaSigma = 0.5;  // things turn, and hide one another in part
constexpr double kMostAreaCost = 6.0;  // a thing half hidden is still the same
constexpr double kCentroidShare =
    0.02;  // of the extent: how far the centroid of a turning thing wanders
constexpr double kSurpriseShare = 0.5;  // of the extent: collisions, pieces of the whole
constexpr double kNewcomerShare = 0.4;  // of a thing's area must show where it touches another
constexpr double kWholeShare = 1.2;     // pieces of one thing are at most this of the whole
constexpr double kApartShare = 0.5;     // of both extents: nearer expected places cannot share
constexpr double kSharedShare = 0.25;  // of the extent: where the border between two things may lie
constexpr double kReachExtents = 1.5;  // from its centre a thing reaches so far
constexpr double kWholeShown = 0.9;    // of the area: outlines flicker, and things turn
constexpr int kSharingRounds = 3;
constexpr int kLeastPoints = 20;
constexpr int kFramesRemembered = 3;  // at least, however slow the camera
constexpr std::size_t kLooks = 64;    // pixels of a segment that stand for it

double squared(double value) {
    return value * value;
}

}  // namespace

Identities::Identities(const RgbdCamera& camera, double memory_s)
    : surface_(camera), memory_(from_seconds(memory_s)), assignment_(kMostThings, kMostThings) {
    // During a frame things and parts can be as many again: newcomers, and shares of touching
    // things.
    things_.reserve(kMostThings);
    parts_.reserve(2 * kMostThings);
    cost_.reserve(kMostThings * kMostThings);
    claimants_.reserve(kMostThings);
    centres_.reserve(kMostThings);
    shares_.reserve(kMostThings);
    taken_.reserve(kMostThings);
}

void Identities::reset() {
    things_.clear();
    next_identity_ = 1;
}

std::span<const Thing> Identities::follow(
    const RgbdFrame& frame, std::span<const MovedPixels> moved
) {
    moved = moved.first(std::min(moved.size(), kMostThings));
    forget(frame.t);
    describe(frame, moved);
    match(frame.t);
    share(frame, moved);
    join_pieces(frame.t);
    begin_new(frame.t);
    see(frame.t);
    last_ = frame.t;
    return things_;
}

std::optional<std::size_t> Identities::owner_of(std::size_t segment) const {
    if (segment >= std::min(parts_.size(), kMostThings)) return std::nullopt;
    const Part& part = parts_[segment];
    if (part.owner == Assignment::kNone || part.shared_u > 0.0) return std::nullopt;
    return static_cast<std::size_t>(part.owner);
}

void Identities::forget(TimeNs t) {
    const TimeNs kept = std::max(memory_, kFramesRemembered * (t - last_));
    std::erase_if(things_, [&](const Thing& thing) { return t - thing.place.seen_at() > kept; });
}

void Identities::describe(const RgbdFrame& frame, std::span<const MovedPixels> moved) {
    parts_.clear();
    for (const auto& pixels : moved) {
        Part part;
        for (const auto pixel : pixels)
            part.moments.add(surface_, surface_.at(frame, pixel));
        parts_.push_back(part);
    }
}

/// Variance of a thing's expected place along an axis, with what cannot be expected.
double Identities::spread2(const Thing& thing, TimeNs t) const {
    const double spread2 = thing.place.variance_at(t) + squared(kSurpriseShare * thing.extent_m);
    return std::min(spread2, squared(kMostSpread));
}

/// The likeliest pairs: -2 log of a Gaussian about the expected place and of one about the size.
void Identities::match(TimeNs t) {
    taken_.assign(things_.size(), 0);
    cost_.clear();
    for (const auto& thing : things_) {
        const Eigen::Vector3d expected = thing.place.at(t);
        const double variance = spread2(thing, t);
        for (const auto& part : parts_) {
            const double far = (part.moments.centroid() - expected).squaredNorm() / variance;
            const double area =
                squared(std::log(part.moments.area_m2 / thing.area_m2) / kLogAreaSigma);
            const double unsure = 3.0 * std::log(1.0 + variance / squared(kUnitSpread));
            cost_.push_back(far > kGate ? kNoneCost : far + std::min(area, kMostAreaCost) + unsure);
        }
    }
    const auto part_of = assignment_.solve(cost_, things_.size(), parts_.size(), kNoneCost);
    for (std::size_t i = 0; i < things_.size(); ++i) {
        if (part_of[i] == Assignment::kNone) continue;
        parts_[static_cast<std::size_t>(part_of[i])].owner = static_cast<int>(i);
        taken_[i] = 1;
    }
}

/// Things that were not found may be part of a segment that is larger than its owner.
void Identities::share(const RgbdFrame& frame, std::span<const MovedPixels> moved) {
    for (std::size_t k = 0; k < moved.size(); ++k) {
        if (std::find(taken_.begin(), taken_.end(), 0) == taken_.end()) return;
        claim(k, frame, moved[k]);
        if (claimants_.size() == 1) {
            parts_[k].owner = static_cast<int>(claimants_.front());
        } else if (claimants_.size() > 1) {
            divide(k, frame, moved[k]);
        }
        for (const std::size_t i : claimants_)
            taken_[i] = 1;
    }
}

/// Whose segment this may be: its owner first, then those whose expected place lies on it, the
/// nearest first, while there is surface left for them.
void Identities::claim(std::size_t k, const RgbdFrame& frame, MovedPixels pixels) {
    claimants_.clear();
    double claimed_m2 = 0.0;
    if (parts_[k].owner != Assignment::kNone) {
        claimants_.push_back(static_cast<std::size_t>(parts_[k].owner));
        claimed_m2 = things_[claimants_.front()].area_m2;
    }
    while (true) {
        double nearest = std::numeric_limits<double>::infinity();
        std::size_t who = things_.size();
        for (std::size_t i = 0; i < taken_.size(); ++i) {
            double distance = 0.0;
            const bool again =
                std::find(claimants_.begin(), claimants_.end(), i) != claimants_.end();
            if (taken_[i] != 0 || again || !reaches(things_[i], frame, pixels, distance)) continue;
            const bool room =
                parts_[k].moments.area_m2 > claimed_m2 + kNewcomerShare * things_[i].area_m2;
            const bool apart =
                std::all_of(claimants_.begin(), claimants_.end(), [&](std::size_t j) {
                    const double between =
                        (things_[i].place.at(frame.t) - things_[j].place.at(frame.t)).norm();
                    return between > kApartShare * (things_[i].extent_m + things_[j].extent_m);
                });
            if (!room || !apart || distance >= nearest) continue;
            nearest = distance;
            who = i;
        }
        if (who == things_.size()) return;
        claimants_.push_back(who);
        claimed_m2 += things_[who].area_m2;
    }
}

bool Identities::reaches(
    const Thing& thing, const RgbdFrame& frame, MovedPixels pixels, double& distance
) const {
    const Eigen::Vector3d expected = thing.place.at(frame.t);
    double nearest2 = std::numeric_limits<double>::infinity();
    const std::size_t step = std::max<std::size_t>(1, pixels.size() / kLooks);
    for (std::size_t k = 0; k < pixels.size(); k += step)
        nearest2 = std::min(nearest2, (surface_.at(frame, pixels[k]) - expected).squaredNorm());
    distance = std::sqrt(nearest2);
    const double unsure = std::min(kMostSpread, std::sqrt(thing.place.variance_at(frame.t)));
    return distance < kSurpriseShare * thing.extent_m + 2.0 * unsure;
}

/// Each pixel to the claimant whose place is nearest in units of its size; the places then move to
/// the middle of what they got, as in Lloyd's algorithm.
void Identities::divide(std::size_t k, const RgbdFrame& frame, MovedPixels pixels) {
    centres_.clear();
    for (const std::size_t i : claimants_)
        centres_.push_back(things_[i].place.at(frame.t));
    for (int round = 0; round < kSharingRounds; ++round) {
        shares_.assign(claimants_.size(), {});
        for (const auto pixel : pixels) {
            const Eigen::Vector3d p_cam = surface_.at(frame, pixel);
            std::size_t nearest = 0;
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t c = 0; c < centres_.size(); ++c) {
                const double extent = std::max(1e-3, things_[claimants_[c]].extent_m);
                const double far = (p_cam - centres_[c]).squaredNorm() / (extent * extent);
                if (far >= least) continue;
                least = far;
                nearest = c;
            }
            shares_[nearest].add(surface_, p_cam);
        }
        for (std::size_t c = 0; c < centres_.size(); ++c)
            if (shares_[c].points > 0) centres_[c] = shares_[c].centroid();
    }
    for (std::size_t c = 0; c < claimants_.size(); ++c) {
        const Thing& thing = things_[claimants_[c]];
        const Part part{shares_[c], static_cast<int>(claimants_[c]), kSharedShare * thing.extent_m};
        if (c == 0) {
            parts_[k] = part;
        } else {
            parts_.push_back(part);
        }
    }
}

/// A segment that nobody owns, near a thing that shows too little of itself, is another piece of
/// it.
void Identities::join_pieces(TimeNs t) {
    for (auto& piece : parts_) {
        if (piece.owner != Assignment::kNone) continue;
        for (const auto& other : parts_) {
            if (other.owner == Assignment::kNone || other.moments.points == 0) continue;
            const Thing& thing = things_[static_cast<std::size_t>(other.owner)];
            const double far = (piece.moments.centroid() - thing.place.at(t)).norm();
            const double reach = kReachExtents * thing.extent_m +
                                 2.0 * std::min(kMostSpread, std::sqrt(thing.place.variance_at(t)));
            double shown = piece.moments.area_m2;
            for (const auto& part : parts_)
                shown += part.owner == other.owner ? part.moments.area_m2 : 0.0;
            if (far > reach || shown > kWholeShare * thing.area_m2) continue;
            piece.owner = other.owner;
            break;
        }
    }
}

/// What nobody owns is new. Where there is no room the thing that was not seen for longest must go.
void Identities::begin_new(TimeNs t) {
    for (auto& part : parts_) {
        if (part.owner != Assignment::kNone) continue;
        const auto place = place_for_new();
        if (!place) continue;
        Thing thing;
        thing.identity = next_identity_++;
        thing.area_m2 = part.moments.area_m2;
        thing.extent_m = part.moments.extent();
        thing.place = PredictedPoint(
            t, part.moments.centroid(), squared(1e-3 + kCentroidShare * thing.extent_m)
        );
        part.owner = static_cast<int>(*place);
        if (*place == things_.size())
            things_.push_back(thing);
        else
            things_[*place] = thing;
    }
}

std::optional<std::size_t> Identities::place_for_new() {
    if (things_.size() < kMostThings) return things_.size();
    std::optional<std::size_t> oldest;
    for (std::size_t i = 0; i < taken_.size(); ++i) {
        if (taken_[i] != 0) continue;
        if (!oldest || things_[i].place.seen_at() < things_[*oldest].place.seen_at()) oldest = i;
    }
    if (oldest) taken_[*oldest] = 1;
    return oldest;
}

void Identities::see(TimeNs t) {
    for (auto& thing : things_) {
        thing.seen = false;
        thing.now = {};
        thing.hidden_u = 0.0;
    }
    for (const auto& part : parts_) {
        if (part.owner == Assignment::kNone) continue;
        Thing& thing = things_[static_cast<std::size_t>(part.owner)];
        thing.now.add(part.moments);
        thing.hidden_u = std::max(thing.hidden_u, part.shared_u);
    }
    for (auto& thing : things_) {
        thing.seen = thing.now.points >= kLeastPoints;
        if (!thing.seen) continue;
        const double shown = thing.now.area_m2 / thing.area_m2;
        const bool shares = thing.hidden_u > 0.0;
        thing.hidden_u += thing.extent_m * std::max(0.0, kWholeShown - shown);
        if (thing.place.seen_at() != t)
            thing.place.observe(
                t,
                thing.now.centroid(),
                squared(1e-3 + kCentroidShare * thing.extent_m) + squared(thing.hidden_u)
            );
        if (shares) continue;
        // It may turn and show more at once; showing less it may be hidden, so that comes slowly.
        const double follow = shown > 1.0 ? 0.3 : 0.03;
        thing.area_m2 += follow * (thing.now.area_m2 - thing.area_m2);
        thing.extent_m += follow * (thing.now.extent() - thing.extent_m);
    }
}

}  // namespace kinectlab
