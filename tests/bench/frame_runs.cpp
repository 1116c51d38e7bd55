#include "tests/bench/frame_runs.hpp"

#include <numbers>
#include <stdexcept>

#include "pipeline/motion/motion.hpp"
#include "pipeline/run/chain.hpp"
#include "server/experiments/share_dir.hpp"

namespace kinectlab::bench {
namespace {

template <class T>
T or_throw(Result<T> result) {
    if (!result) throw std::runtime_error(to_text(result.error()));
    if constexpr (!std::is_void_v<T>) return std::move(*result);
}

/// In the actuator's units.
std::optional<double> displacement_of(const FrameExperiment& experiment) {
    std::optional<double> value;
    for (const auto& step : experiment.definition.sequence) {
        if (step.kind != experiments::SequenceStep::Kind::displace) continue;
        value = experiments::value_of(step.to, experiment.values);
        if (value && step.to.parameter && step.to.parameter->ends_with("_deg"))
            *value *= std::numbers::pi / 180.0;
    }
    return value;
}

}  // namespace

FrameExperiment frame_experiment(
    const std::string& id, double seconds, const experiments::Values& changes
) {
    FrameExperiment experiment;
    experiment.definition =
        or_throw(experiments::load_definition(experiments::share_dir() / "experiments", id));
    experiment.values = or_throw(experiments::validate(experiment.definition, changes));
    experiment.seconds = seconds;
    return experiment;
}

simulate::RunSettings run_settings_of(const FrameExperiment& experiment) {
    simulate::RunSettings run;
    run.rig.apparatus =
        or_throw(simulate::settings_for(experiment.definition.apparatus, experiment.values));
    run.rig.with_colour = false;
    run.displacement = displacement_of(experiment);
    run.seconds = experiment.seconds;
    run.rest_s = 1.0;
    run.held_s = 0.5;
    return run;
}

FrameRun seen_run(const FrameExperiment& experiment, std::uint64_t seed) {
    simulate::RunSettings run = run_settings_of(experiment);
    run.rig.seed = seed;
    const auto rig = or_throw(simulate::SimulatedRig::create(run.rig));
    const TrackingPlan plan = experiments::plan_for(experiment.definition, experiment.values);
    Chain chain = or_throw(Chain::create({rig.camera(), plan.objects, plan.preprocess}));
    std::vector<std::vector<TrackSample>> samples(plan.objects.size());
    FrameRun seen;
    or_throw(simulate::simulate_run(
        run,
        [&](const RgbdFrame& frame, const simulate::Truth& truth) -> Result<void> {
            if (truth.motion == simulate::Motion::at_rest) return chain.learn(frame);
            const bool free = truth.motion == simulate::Motion::free;
            if (!free)
                if (auto ok = chain.uncover(frame); !ok) return ok;
            auto found = chain.track(frame);
            if (!found) return tl::unexpected(found.error());
            if (!free) return {};
            for (const auto& sample : *found)
                samples[sample.object].push_back(sample);
            seen.truth.push_back(truth);
            return {};
        }
    ));
    for (std::size_t i = 0; i < samples.size(); ++i)
        seen.objects.push_back(to_trajectory(
            plan.objects[i].name,
            samples[i],
            rig.T_lab_cam(),
            {.frame_period_s = 1.0 / simulate::kFrameRateHz}
        ));
    return seen;
}

AnalysisOutcome analysed(
    const FrameExperiment& experiment,
    const FrameRun& run,
    const std::map<std::string, std::optional<double>>& overrides
) {
    return or_throw(experiments::evaluate(
                        {experiment.definition, experiment.values, run.objects, {}, overrides},
                        {},
                        run.objects.front().samples.front().t
                    ))
        .outcome;
}

}  // namespace kinectlab::bench
