#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/pipeline/analysis/swing_generator.hpp"

namespace kinectlab::testing {
namespace {

using ::testing::HasSubstr;

Result<AnalysisOutcome> foucault(const Trajectory& path) {
    return analyse(
        "foucault",
        std::span(&path, 1),
        {{"length_m", 1.0}, {"bob_radius_m", 0.05}, {"bob_density_kg_m3", 0.0}},
        {}
    );
}

const Measurement& of(const AnalysisOutcome& outcome, std::string_view name) {
    for (const auto& m : outcome.measurements)
        if (m.name == name) return m;
    throw std::out_of_range(std::string(name));
}

TEST(Foucault, FindsTheLatitudeBesideAnEllipse) {
    for (const double sideways : {0.0, -0.0063}) {
        const Swing swing{
            .amplitude_deg = 12, .sideways = sideways, .damping = 5e-4, .seconds = 300};
        const auto outcome = foucault(with_noise(generate(swing), 1, {2e-4, 2e-4}));
        ASSERT_TRUE(outcome) << to_text(outcome.error());
        const auto& latitude = of(*outcome, "latitude");
        EXPECT_NEAR(latitude.value, 45.0, 3.0 * latitude.u);
        EXPECT_LT(latitude.u, 1.0);
        EXPECT_NEAR(of(*outcome, "ellipse_b").value, sideways / 3.13, 3e-5);
        EXPECT_NEAR(of(*outcome, "g").value, 9.81, 0.01);
        EXPECT_EQ(outcome->plots.size(), 6U);
        EXPECT_GT(outcome->facts.at("periods"), 140.0);
    }
}

TEST(Foucault, FasterThanTheEarthIsNoLatitude) {
    Trajectory path = with_noise(generate({.seconds = 120}), 1, {1e-4, 1e-4});
    for (auto& m : path.samples)
        m.p_lab = Eigen::AngleAxisd(
                      -3e-4 * to_seconds(m.t - path.samples.front().t), Eigen::Vector3d::UnitZ()
                  ) *
                  m.p_lab;
    const auto outcome = foucault(path);
    ASSERT_TRUE(outcome) << to_text(outcome.error());
    EXPECT_THROW(of(*outcome, "latitude"), std::out_of_range);
    EXPECT_THAT(outcome->warnings, ::testing::Contains(HasSubstr("faster than the Earth")));
}

TEST(Foucault, OnePlaneAloneIsRefused) {
    Trajectory path = generate({.seconds = 20});
    for (auto& m : path.samples)
        m.p_lab.y() = 0.0;
    EXPECT_THAT(foucault(path).error().message, HasSubstr("one plane"));
}

}  // namespace
}  // namespace kinectlab::testing
