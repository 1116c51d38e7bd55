#include "server/store/poses.hpp"

#include <cmath>
#include <limits>

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>

namespace kinectlab::store {
namespace {

/// The columns as numbers; NaN is stored as NULL.
constexpr int kNumbers = 26;
using Numbers = std::array<double, kNumbers>;

Numbers to_numbers(const MotionSample& s) {
    const Eigen::Vector3d sigma = s.sigma_p();
    const Eigen::Quaterniond& q = s.q_lab_obj;
    Eigen::Matrix3d turn = s.covariance.bottomRightCorner<3, 3>();
    if (!s.has_orientation) turn.setConstant(std::numeric_limits<double>::quiet_NaN());
    return {
        s.p_lab.x(),
        s.p_lab.y(),
        s.p_lab.z(),
        q.x(),
        q.y(),
        q.z(),
        q.w(),
        sigma.x(),
        sigma.y(),
        sigma.z(),
        s.covariance(0, 1),
        s.covariance(0, 2),
        s.covariance(1, 2),
        s.v_lab.x(),
        s.v_lab.y(),
        s.v_lab.z(),
        s.w_lab.x(),
        s.w_lab.y(),
        s.w_lab.z(),
        s.quality.rms_steps,
        turn(0, 0),
        turn(1, 1),
        turn(2, 2),
        turn(0, 1),
        turn(0, 2),
        turn(1, 2)};
}

void from_numbers(const Numbers& n, MotionSample& s) {
    s.p_lab = {n[0], n[1], n[2]};
    s.q_lab_obj = Eigen::Quaterniond(n[6], n[3], n[4], n[5]);
    for (int i = 0; i < 3; ++i)
        s.covariance(i, i) = n[7 + i] * n[7 + i];
    s.covariance(0, 1) = s.covariance(1, 0) = n[10];
    s.covariance(0, 2) = s.covariance(2, 0) = n[11];
    s.covariance(1, 2) = s.covariance(2, 1) = n[12];
    s.v_lab = {n[13], n[14], n[15]};
    s.w_lab = {n[16], n[17], n[18]};
    s.quality.rms_steps = n[19];
    if (std::isnan(n[20])) return;
    Eigen::Matrix3d turn;
    turn << n[20], n[23], n[24], n[23], n[21], n[25], n[24], n[25], n[22];
    s.covariance.bottomRightCorner<3, 3>() = turn;
}

constexpr const char* kInsert =
    "INSERT INTO poses (run_id, object, t_ns, status, has_orientation, points, inlier_share, "
    "x, y, z, qx, qy, qz, qw, sx, sy, sz, cxy, cxz, cyz, vx, vy, vz, wx, wy, wz, rms_steps, "
    "rxx, ryy, rzz, rxy, rxz, ryz) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
    "?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)";

constexpr const char* kSelect =
    "SELECT object, t_ns, status, has_orientation, points, inlier_share, x, y, z, qx, qy, qz, qw, "
    "sx, sy, sz, cxy, cxz, cyz, vx, vy, vz, wx, wy, wz, rms_steps, rxx, ryy, rzz, rxy, rxz, ryz "
    "FROM poses WHERE run_id = ? ORDER BY object, t_ns";

void insert_pose(
    SQLite::Statement& insert, lab::RunId run, const std::string& object, const MotionSample& s
) {
    insert.reset();
    SQLite::bind(
        insert,
        run,
        object,
        s.t,
        static_cast<int>(s.status),
        s.has_orientation ? 1 : 0,
        s.quality.points,
        s.quality.inlier_share
    );
    const Numbers numbers = to_numbers(s);
    for (int i = 0; i < kNumbers; ++i)
        insert.bind(8 + i, numbers.at(i));
    insert.exec();
}

MotionSample read_sample(SQLite::Statement& row) {
    MotionSample s;
    s.t = row.getColumn(1).getInt64();
    s.status = static_cast<TrackStatus>(row.getColumn(2).getInt());
    s.has_orientation = row.getColumn(3).getInt() != 0;
    s.quality.points = row.getColumn(4).getInt();
    s.quality.inlier_share = row.getColumn(5).getDouble();
    Numbers numbers{};
    for (int i = 0; i < kNumbers; ++i) {
        const SQLite::Column column = row.getColumn(6 + i);
        numbers.at(i) =
            column.isNull() ? std::numeric_limits<double>::quiet_NaN() : column.getDouble();
    }
    from_numbers(numbers, s);
    return s;
}

}  // namespace

void PoseRepository::append(
    lab::RunId run, std::span<const StoredPose> poses, const std::optional<FrameCounts>& so_far
) {
    Database::Transaction transaction(database_);
    SQLite::Statement insert(transaction.connection(), kInsert);
    for (const auto& pose : poses)
        insert_pose(insert, run, pose.object, pose.sample);
    if (so_far) {
        SQLite::Statement count(
            transaction.connection(),
            "UPDATE runs SET frames = max(frames, ?), frames_lost = max(frames_lost, ?) "
            "WHERE id = ?"
        );
        SQLite::bind(count, so_far->frames, so_far->lost, run);
        count.exec();
    }
    transaction.commit();
}

void PoseRepository::replace(lab::RunId run, std::span<const Trajectory> trajectories) {
    Database::Transaction transaction(database_);
    SQLite::Statement clear(transaction.connection(), "DELETE FROM poses WHERE run_id = ?");
    clear.bind(1, run);
    clear.exec();
    SQLite::Statement insert(transaction.connection(), kInsert);
    for (const auto& trajectory : trajectories) {
        for (const auto& sample : trajectory.samples) {
            insert_pose(insert, run, trajectory.object, sample);
        }
    }
    transaction.commit();
}

std::vector<Trajectory> PoseRepository::of_run(lab::RunId run) {
    Database::Reader reader(database_);
    SQLite::Statement query(reader.connection(), kSelect);
    query.bind(1, run);
    std::vector<Trajectory> trajectories;
    while (query.executeStep()) {
        const std::string object = query.getColumn(0).getString();
        if (trajectories.empty() || trajectories.back().object != object) {
            trajectories.push_back({object, {}});
        }
        trajectories.back().samples.push_back(read_sample(query));
    }
    return trajectories;
}

std::size_t PoseRepository::count(lab::RunId run) {
    Database::Reader reader(database_);
    SQLite::Statement query(reader.connection(), "SELECT count(*) FROM poses WHERE run_id = ?");
    query.bind(1, run);
    query.executeStep();
    return static_cast<std::size_t>(query.getColumn(0).getInt64());
}

}  // namespace kinectlab::store
