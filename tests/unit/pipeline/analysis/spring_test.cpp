#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/pipeline/analysis/law_paths.hpp"

namespace kinectlab::testing {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kOmega = 6.3;
constexpr double kGamma = 0.05;
const double kDamped = std::sqrt(kOmega * kOmega - kGamma * kGamma);

/// Held down for a second, then free.
Vector3d bobs(double t) {
    const double s = std::max(t - 1.0, 0.0);
    const double x =
        std::exp(-kGamma * s) * (std::cos(kDamped * s) + kGamma / kDamped * std::sin(kDamped * s));
    return {0.0, 1.5, 0.4 - 0.08 * x};
}

/// From rest, driven by f cos(ωt).
Vector3d driven(double t, double drive) {
    const double stiff = kOmega * kOmega - drive * drive;
    const double lost = 2.0 * kGamma * drive;
    const double f = 0.3 / (stiff * stiff + lost * lost);
    const double c = f * stiff;
    const double s = f * lost;
    const double a = -c;
    const double b = (-s * drive + kGamma * a) / kDamped;
    const double x =
        c * std::cos(drive * t) + s * std::sin(drive * t) +
        std::exp(-kGamma * t) * (a * std::cos(kDamped * t) + b * std::sin(kDamped * t));
    return {0.0, 1.5, 0.4 + x};
}

void expect_near_truth(const AnalysisOutcome& out, const std::string& name, double truth) {
    const Measurement& m = named(out, name);
    EXPECT_NEAR(m.value, truth, 3.3 * m.u) << name;
    EXPECT_NEAR(combined(m.budget), m.u, 1e-12 + 1e-9 * m.u) << name;
}

const AnalysisSettings kMass{{"mass_kg", 0.2}, {"spring_mass_kg", 0.03}};

TEST(Spring, TellsPeriodStiffnessAndDamping) {
    for (const Lasting lasting : {Lasting::no, Lasting::yes}) {
        const auto out = analysed("spring", record(20.0, bobs, 5, lasting), kMass);
        ASSERT_TRUE(out) << to_text(out.error());
        expect_near_truth(*out, "period", 2.0 * pi / kDamped);
        expect_near_truth(*out, "angular_frequency", kOmega);
        expect_near_truth(*out, "stiffness", 0.21 * kOmega * kOmega);
        expect_near_truth(*out, "damping", kGamma);
        expect_near_truth(*out, "quality_factor", kOmega / (2.0 * kGamma));
        expect_near_truth(
            *out,
            "amplitude",
            0.08 * kOmega / kDamped * std::exp(-kGamma * (out->facts.at("start_s") - 1.0))
        );
        EXPECT_NEAR(out->facts.at("periods"), 18.5, 1.0);
        EXPECT_THAT(out->warnings, Contains(HasSubstr("The first 1.")));
        EXPECT_EQ(out->plots.size(), 4u);
    }
}

TEST(Spring, ASpringThatWasNotWeighedIsALineAndNoGuess) {
    const auto out = analysed("spring", record(20.0, bobs, 5), {{"mass_kg", 0.2}});
    ASSERT_TRUE(out) << to_text(out.error());
    const Measurement& k = named(*out, "stiffness");
    const double massless = 0.2 * kOmega * kOmega;
    EXPECT_NEAR(k.value, massless, 1e-3 * massless);
    EXPECT_NEAR(line(k, "spring mass"), massless * 0.1 / 3.0 / std::sqrt(3.0), 1e-3 * massless);
    EXPECT_THAT(out->notes, Contains(HasSubstr("spring_mass_kg was not given")));
}

TEST(Spring, TellsTheDragOfTheSquareFromThatOfTheSpeed) {
    const auto linear = analysed("spring", record(20.0, bobs, 5), kMass);
    ASSERT_TRUE(linear) << to_text(linear.error());
    EXPECT_THAT(
        linear->notes, Contains(HasSubstr("in proportion to the speed; one of its square"))
    );

    std::vector<double> x;  // of x'' = -ω² x - β |x'| x', by small steps
    double z = -0.08;
    double v = 0.0;
    for (int i = 0; i < 20 * 3000; ++i) {
        if (i % 100 == 0) x.push_back(z);
        const double h = 1.0 / 3000.0;
        v += h / 2 * (-kOmega * kOmega * z - 0.5 * std::abs(v) * v);
        z += h * v;
        v += h / 2 * (-kOmega * kOmega * z - 0.5 * std::abs(v) * v);
    }
    const auto out = analysed(
        "spring",
        record(
            20.0,
            [&](double t) {
                return Vector3d(0.0, 1.5, x[static_cast<std::size_t>(std::lround(t * 30.0))]);
            }
        ),
        kMass
    );
    ASSERT_TRUE(out) << to_text(out.error());
    EXPECT_NEAR(named(*out, "quadratic_drag").value, 0.5, 0.05);
    EXPECT_THAT(out->notes, Contains(HasSubstr("drag of the speed's square")));
}

TEST(Spring, DrivenFromRestItTellsTheResonance) {
    const double drive = 2.0 * pi * 0.9;
    AnalysisSettings settings = kMass;
    settings["drive_hz"] = 0.9;
    const auto out =
        analysed("spring", record(30.0, [&](double t) { return driven(t, drive); }), settings);
    ASSERT_TRUE(out) << to_text(out.error());
    const double stiff = kOmega * kOmega - drive * drive;
    const double lost = 2.0 * kGamma * drive;
    expect_near_truth(*out, "steady_amplitude", 0.3 / std::hypot(stiff, lost));
    expect_near_truth(*out, "phase_lag", std::atan2(lost, stiff));
    expect_near_truth(
        *out, "resonance_frequency", std::sqrt(kOmega * kOmega - 2.0 * kGamma * kGamma) / (2.0 * pi)
    );
}

TEST(Spring, ASteadyAnswerDoesNotTellTheResonance) {
    AnalysisSettings settings = kMass;
    settings["drive_hz"] = 0.9;
    const auto steady = [](double t) {
        return Vector3d(0.0, 1.5, 0.03 * std::cos(2.0 * pi * 0.9 * t));
    };
    const auto out = analysed("spring", record(20.0, steady), settings);
    ASSERT_TRUE(out) << to_text(out.error());
    EXPECT_EQ(find(*out, "stiffness"), nullptr);
    EXPECT_EQ(find(*out, "phase_lag"), nullptr);
    expect_near_truth(*out, "steady_amplitude", 0.03);
    EXPECT_THAT(out->notes, Contains(HasSubstr("died away")));
}

TEST(Spring, InPixelsAllThatNeedsNoScale) {
    AnalysisConditions conditions;
    conditions.metric = false;
    const auto out = analysed(
        "spring",
        record(
            15.0, [](double t) { return Vector3d(500.0 * bobs(t)); }, 1, Lasting::no, 500.0
        ),
        kMass,
        conditions
    );
    ASSERT_TRUE(out) << to_text(out.error());
    expect_near_truth(*out, "period", 2.0 * pi / kDamped);
    expect_near_truth(*out, "stiffness", 0.21 * kOmega * kOmega);
    EXPECT_EQ(find(*out, "amplitude"), nullptr);
    EXPECT_THAT(out->notes, Contains(HasSubstr("pixels")));
}

TEST(Spring, RefusesWhatDoesNotSwing) {
    const auto message = [](double seconds, const std::function<Vector3d(double)>& p) {
        const auto out = analysed("spring", record(seconds, p));
        return out ? std::string("a number came out") : out.error().message;
    };
    EXPECT_THAT(
        message(5.0, [](double) { return Vector3d(0, 1, 0); }), HasSubstr("nothing swings")
    );
    EXPECT_THAT(message(2.5, bobs), HasSubstr("period"));
    EXPECT_THAT(message(0.5, bobs), HasSubstr("15 of 15 frames"));
    EXPECT_NE(message(5.0, [](double t) { return Vector3d(0, 1, 0.2 * t); }), "a number came out");
}

}  // namespace
}  // namespace kinectlab::testing
