#include "server/commands/pose_table.hpp"

#include <algorithm>

#include "server/experiments/poses_csv.hpp"

namespace kinectlab::commands {

std::string poses_to_csv(const std::vector<Trajectory>& trajectories) {
    struct Row {
        const Trajectory* trajectory;
        const MotionSample* sample;
    };
    std::vector<Row> rows;
    for (const auto& trajectory : trajectories)
        for (const auto& sample : trajectory.samples)
            rows.push_back({&trajectory, &sample});
    std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
        return a.sample->t < b.sample->t;
    });
    std::string csv = experiments::poses_csv_header();
    for (const auto& [trajectory, sample] : rows)
        experiments::append_pose_row(csv, trajectory->object, *sample);
    return csv;
}

}  // namespace kinectlab::commands
