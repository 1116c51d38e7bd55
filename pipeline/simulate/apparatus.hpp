#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/core/error.hpp"
#include "pipeline/simulate/body.hpp"
#include "pipeline/simulate/parameters.hpp"
#include "pipeline/simulate/scene.hpp"

namespace kinectlab::simulate {

enum class Motion : std::uint8_t {
    at_rest,  ///< where stop leaves it
    moving,   ///< an arm brings it to where it was told to
    held,
    free,     ///< since the release, also when it has come to rest by itself
    braking,  ///< on its way to rest
};

enum class Action : std::uint8_t {
    stop,      ///< bring everything to rest, where the scene behind it can be learned
    displace,  ///< bring everything to the start, displaced by a value, and hold it there
    hold,      ///< hold everything where it is
    release,   ///< let go
};

struct Command {
    Action action = Action::stop;
    double value = 0.0;  ///< displace: rad or m, as the apparatus says
};

/// Everything as it truly is at one time.
struct Truth {
    double t_s = 0.0;  ///< since the rig was switched on
    Motion motion = Motion::at_rest;
    double value = 0.0;        ///< what displace sets, as it is now
    std::vector<Body> bodies;  ///< at least one; always the same ones in the same order

    [[nodiscard]] const Body& body() const { return bodies.front(); }
};

/// Something that moves by the laws of nature once it is let go, with an arm that brings it to its
/// start and a device that holds it there. Its time is what advance_to() says.
class Apparatus {
public:
    Apparatus() = default;
    virtual ~Apparatus() = default;

    /// Takes effect at the time of the last advance_to(). Release of what is at rest or free
    /// already changes nothing. A value out of reach is refused.
    [[nodiscard]] virtual Result<void> apply(const Command& command) = 0;

    /// Seconds; times before the last one are ignored. Where things are does not depend on how
    /// often this is called.
    virtual void advance_to(double t_s) = 0;

    [[nodiscard]] virtual double t_s() const = 0;
    [[nodiscard]] virtual Motion motion() const = 0;
    [[nodiscard]] virtual double value() const = 0;  ///< echo of displace
    [[nodiscard]] virtual std::vector<Body> bodies() const = 0;
    [[nodiscard]] virtual std::vector<Wire> wires() const { return {}; }

    /// What of the room belongs to it; does not change.
    [[nodiscard]] virtual Furniture furniture() const = 0;

    /// Where a body rests in view it hides some of the scene: before it is displaced to `value` it
    /// should be held at this one, too. None where stop takes everything out of the picture.
    [[nodiscard]] virtual std::optional<double> aside(double value) const {
        (void)value;
        return std::nullopt;
    }

    /// The displacement of an ordinary run.
    [[nodiscard]] virtual double usual_value() const { return 0.0; }

    [[nodiscard]] Truth truth() const { return {t_s(), motion(), value(), bodies()}; }

protected:
    Apparatus(const Apparatus&) = default;
    Apparatus& operator=(const Apparatus&) = default;
};

/// Which apparatus, and those of its parameters that are not as usual.
struct ApparatusSettings {
    std::string name = "pendulum";
    ParameterMap parameters;
};

[[nodiscard]] std::vector<std::string> apparatus_names();

/// What the apparatus of this name can be given; an unknown name is refused with the nearest one.
[[nodiscard]] Result<std::span<const ParameterRange>> parameters_of(std::string_view apparatus);

/// Those of `values` that the apparatus knows; the others belong to the run.
[[nodiscard]] Result<ApparatusSettings> settings_for(
    std::string_view apparatus, const ParameterMap& values
);

/// At rest at time 0. Errors name the parameter that is unknown, out of its range, or does not go
/// together with the others.
[[nodiscard]] Result<std::unique_ptr<Apparatus>> make_apparatus(const ApparatusSettings& settings);

}  // namespace kinectlab::simulate
