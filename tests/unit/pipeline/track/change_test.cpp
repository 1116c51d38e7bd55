#include <gtest/gtest.h>

#include "pipeline/run/chain.hpp"
#include "pipeline/sensor/recording.hpp"
#include "tests/unit/pipeline/support/shared_data.hpp"
#include "tests/unit/pipeline/support/textured_scene.hpp"

namespace kinectlab {
namespace {

using test::PrintedBox;
using test::TexturedScene;

TexturedScene without_noise() {
    TexturedScene scene(1, 2);
    scene.sigma_steps = scene.edge_px = scene.colour_noise = 0.0;
    return scene;
}

/// Tracks whatever moves before a scene that was learned while it was empty.
class Watched {
public:
    explicit Watched(TexturedScene scene)
        : scene_(std::move(scene)),
          chain_(Chain::create({scene_.camera, {{"moved", ChangeTrackSettings{}}}}).value()) {
        for (int i = 0; i < 5; ++i)
            EXPECT_TRUE(chain_.learn(scene_.frame({})));
    }

    TrackSample look(const PrintedBox& box) {
        const auto samples = chain_.track(scene_.frame({box})).value();
        EXPECT_EQ(samples.size(), 1U);
        return samples.empty() ? TrackSample{} : samples.front();
    }

private:
    TexturedScene scene_;
    Chain chain_;
};

PrintedBox leaning_box(double x) {
    PrintedBox box;
    box.print = 0;
    box.half_m = {0.08, 0.10, 0.03};
    box.T_cam_box.translation() = Eigen::Vector3d(x, 0.02, 1.3);
    box.T_cam_box.linear() =
        Eigen::AngleAxisd(0.6, Eigen::Vector3d(0.3, 1.0, 0.2).normalized()).toRotationMatrix();
    return box;
}

/// Mean over frames and seeds of eᵀ Σ⁻¹ e for each degree of freedom; e is the error against what
/// is told of the same frames without noise.
double normalised_error(double motion_m) {
    double sum = 0.0;
    int count = 0;
    for (unsigned seed = 1; seed <= 4; ++seed) {
        Watched noisy(TexturedScene(seed, 2)), exact(without_noise());
        for (int i = 0; i < 12; ++i) {
            const PrintedBox box = leaning_box(-0.1 + motion_m * i + 0.0031 * seed);
            const TrackSample told = noisy.look(box), truth = exact.look(box);
            EXPECT_EQ(told.status, TrackStatus::tracked);
            if (told.status != TrackStatus::tracked) continue;
            const Eigen::Vector3d off = told.p_cam - truth.p_cam;
            const Eigen::Matrix3d covariance = told.covariance.topLeftCorner<3, 3>();
            sum += off.dot(covariance.inverse() * off) / 3.0;
            ++count;
        }
    }
    return sum / count;
}

TEST(Change, CovarianceCoversTheErrorAtRest) {
    const double error = normalised_error(0.0);
    EXPECT_GT(error, 0.5);
    EXPECT_LT(error, 2.0);
}

TEST(Change, CovarianceCoversTheErrorInMotion) {
    const double error = normalised_error(0.011);
    EXPECT_GT(error, 0.5);
    EXPECT_LT(error, 2.0);
}

TEST(ChangeOnRealFrames, ABoxAtRestScattersAsTold) {
    const auto folder = test::shared_data() / "xtion_boxes";
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "no recordings of real sensors at " << test::shared_data();
    auto source = open_recording(folder);
    ASSERT_TRUE(source);
    auto chain = Chain::create({(*source)->info().camera, {{"moved", ChangeTrackSettings{}}}});
    ASSERT_TRUE(chain);
    RgbdFrame frame;
    std::vector<TrackSample> box;  // the bigger of two things, put down before the ninth frame
    for (int i = 0; (*source)->next(frame, std::chrono::milliseconds(1000)) == FrameStatus::frame;
         ++i) {
        if (i == 0) {
            ASSERT_TRUE(chain->learn(frame));
        }
        const auto tracked = chain->track(frame);
        ASSERT_TRUE(tracked) << to_text(tracked.error());
        for (const auto& sample : *tracked)
            if (i >= 8 && sample.identity == 1) box.push_back(sample);
    }
    ASSERT_EQ(box.size(), 3U);
    const Eigen::Vector3d mean = (box[0].p_cam + box[1].p_cam + box[2].p_cam) / 3.0;
    Eigen::Vector3d scatter = Eigen::Vector3d::Zero(), told = Eigen::Vector3d::Zero();
    for (const auto& sample : box) {
        scatter += (sample.p_cam - mean).cwiseAbs2() / 2.0;
        told += sample.covariance.diagonal().head<3>() / 3.0;
    }
    const double ratio = scatter.cwiseQuotient(told).mean();  // six degrees of freedom
    EXPECT_GT(ratio, 0.3);
    EXPECT_LT(ratio, 2.5);
}

}  // namespace
}  // namespace kinectlab
