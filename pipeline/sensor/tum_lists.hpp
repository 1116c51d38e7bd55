#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "pipeline/core/error.hpp"
#include "pipeline/core/time.hpp"

namespace kinectlab {

/// One line "timestamp path" of depth.txt or rgb.txt.
struct TumEntry {
    TimeNs t = 0;
    std::filesystem::path file;  ///< with the recording's folder in front
    int line = 0;
};

/// Seconds since the epoch, at most nine digits after the point, exactly; nothing if it is no such
/// number, negative or after the year 2262.
[[nodiscard]] std::optional<TimeNs> parse_timestamp(std::string_view text);

/// Seconds with nine digits after the point; parse_timestamp gives the same time back.
[[nodiscard]] std::string format_timestamp(TimeNs t);

/// Reads a list; # begins a comment. Errors name file and line: malformed lines, times that repeat
/// or run backwards, paths that lead out of the folder, files that are not there, an empty list.
[[nodiscard]] Result<std::vector<TumEntry>> read_tum_list(
    const std::filesystem::path& folder, const std::string& list
);

/// For each depth picture the index of the colour picture nearest in time, nothing where the
/// nearest is farther away than one median step of the depth list.
[[nodiscard]] std::vector<std::optional<std::size_t>> pair_by_time(
    const std::vector<TumEntry>& depth, const std::vector<TumEntry>& colour
);

/// Median time between neighbours, ns; 0 for fewer than two entries.
[[nodiscard]] TimeNs median_step(const std::vector<TumEntry>& entries);

/// One line "timestamp tx ty tz qx qy qz qw" of groundtruth.txt.
struct TumPose {
    TimeNs t = 0;
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

/// groundtruth.txt of a recording; the pipeline does not read it, tests and comparisons do.
[[nodiscard]] Result<std::vector<TumPose>> read_groundtruth(const std::filesystem::path& folder);

}  // namespace kinectlab
