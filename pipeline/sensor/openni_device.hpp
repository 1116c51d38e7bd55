#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/core/error.hpp"

namespace kinectlab {

/// What an open device says about its streams.
struct OpenniModes {
    int width = 0;  ///< of depth
    int height = 0;
    int colour_width = 0;  ///< 0: no colour stream
    int colour_height = 0;
    double depth_unit_m = 0.001;
    double horizontal_fov_rad = 0.0;         ///< of depth; 0: the driver does not say
    double colour_horizontal_fov_rad = 0.0;  ///< 0: the driver does not say
    double fps = 30.0;
    std::string name;                            ///< vendor and product
    std::optional<std::size_t> recorded_frames;  ///< depth frames of an .oni file
};

/// The device's own counter and clock.
struct OpenniStamp {
    std::uint64_t index = 0;
    std::uint64_t t_us = 0;
};

/// One device or .oni file through OpenNI2, its depth and colour streams started; pictures come out
/// unmirrored. Behind it hides everything of OpenNI2, which no other file includes.
/// One thread waits and copies; set_property and get_property may be called from another.
class OpenniDevice {
public:
    /// `uri` as OpenNI2 lists it, or an .oni file's path; empty: any device.
    /// Error `unavailable` names it and lists the devices that are there.
    [[nodiscard]] static Result<std::unique_ptr<OpenniDevice>> open(
        const std::string& uri, bool with_colour
    );

    OpenniDevice(const OpenniDevice&) = delete;
    OpenniDevice& operator=(const OpenniDevice&) = delete;
    ~OpenniDevice();

    [[nodiscard]] const OpenniModes& modes() const;

    enum class Event {
        depth,   ///< a new depth picture: depth_stamp, copy_depth
        colour,  ///< a new colour picture: colour_stamp, copy_colour
        none,    ///< nothing came in time
        gone,    ///< the device was unplugged, or a stream failed
    };
    /// A picture that is not copied before the next of its kind is lost, which its index shows.
    [[nodiscard]] Event wait(std::chrono::milliseconds timeout);

    [[nodiscard]] OpenniStamp depth_stamp() const;
    [[nodiscard]] OpenniStamp colour_stamp() const;
    void copy_depth(std::vector<std::uint16_t>& depth) const;
    void copy_colour(std::vector<std::uint8_t>& rgb) const;

    [[nodiscard]] bool set_property(int id, std::span<const std::byte> data);
    /// False also where the property has another size than `data`.
    [[nodiscard]] bool get_property(int id, std::span<std::byte> data);

private:
    struct State;
    explicit OpenniDevice(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace kinectlab
