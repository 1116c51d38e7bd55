#include "server/rig/run_execution.hpp"

#include <utility>

#include <nlohmann/json.hpp>

#include "server/lab/utc.hpp"

namespace kinectlab::rig {
namespace {

using lab::RunEvent;
using lab::RunState;

bool needs_frames(RunState state) {
    return state == RunState::preparing || state == RunState::ready ||
           state == RunState::releasing || state == RunState::measuring;
}

}  // namespace

RunExecution::RunExecution(
    RunSurroundings rig, const lab::Run& run, TimeNs now, const RunLimits& limits
)
    : rig_(rig), run_(run), limits_(limits), last_frame_at_(now) {}

void RunExecution::step(TimeNs now, const RgbdFrame* frame, std::uint32_t missed) {
    if (frame != nullptr) last_frame_at_ = now;
    act_on_changes(now);
    if (over_ || !entered_) return;
    if (frame != nullptr) observe(*entered_, now, *frame, missed);
    watch(*entered_, now);
}

/// A change may call for the next at once; each is acted on only after it was stored.
void RunExecution::act_on_changes(TimeNs now) {
    for (auto run = rig_.active.current(); !over_ && run && entered_ != run->state;
         run = rig_.active.current()) {
        run_ = *run;
        enter(run_.state, now);
    }
}

void RunExecution::enter(RunState state, TimeNs now) {
    entered_ = state;
    entered_at_ = now;
    const bool counts = state == RunState::releasing || state == RunState::measuring;
    rig_.device.source->hold_clock(counts);
    switch (state) {
        case RunState::preparing:
            if (auto begun = begin_preparation(); !begun) fail_run(now, begun.error());
            break;
        case RunState::ready:
            break;
        case RunState::releasing:
            if (auto sent = rig_.device.actuator->release(); !sent) fail_run(now, sent.error());
            break;
        case RunState::measuring:
            break;
        case RunState::analysing: {
            stop_bob();
            rig_.writer.flush();
            save_frames();
            run_ = rig_.active.current().value_or(run_);  // with its frames
            RunMeasured measured{run_, rig_.device.source->info(), samples_};
            analysis_ = std::async(
                std::launch::async,
                [measured = std::move(measured), &store = rig_.store]() -> Result<RunAnalysis> {
                    const auto trajectories = final_trajectories(measured);
                    store.poses.replace(measured.run.id, trajectories);
                    return analyse_run(measured, trajectories);
                }
            );
            break;
        }
        case RunState::completed:
            over_ = true;
            break;
        case RunState::aborted:
        case RunState::failed:
        case RunState::interrupted:
            stop_bob();
            rig_.writer.flush();
            save_frames();
            over_ = true;
            break;
    }
}

Result<void> RunExecution::begin_preparation() {
    auto definition =
        experiments::read_definition(nlohmann::json::parse(run_.definition_json, nullptr, false));
    if (!definition) return tl::unexpected(definition.error());
    preparation_.emplace(*rig_.device.actuator, preparation_for(*definition, run_.parameters));
    end_watch_.emplace(definition->early_end);
    return rig_.device.actuator->configure(definition->apparatus, run_.parameters);
}

void RunExecution::observe(
    RunState state, TimeNs now, const RgbdFrame& frame, std::uint32_t missed
) {
    if (state == RunState::preparing) {
        prepare(now, frame, missed);
    } else {
        track(state, now, frame, missed);
    }
}

void RunExecution::prepare(TimeNs now, const RgbdFrame& frame, std::uint32_t missed) {
    if (!preparation_) return;  // it was refused, and the run has failed
    const auto progress = preparation_->step(now);
    if (!progress) return fail_run(now, progress.error());
    if (progress->learn) {
        if (auto learned = rig_.observer.learn(frame); !learned) fail_run(now, learned.error());
    } else if (rig_.observer.learned_frames() > 0) {
        track(RunState::preparing, now, frame, missed);
    }
    if (progress->done) advance(RunEvent::prepared, now, "Everything is in place");
}

void RunExecution::track(RunState state, TimeNs now, const RgbdFrame& frame, std::uint32_t missed) {
    const auto observed = rig_.observer.track(frame);
    if (!observed) return fail_run(now, observed.error());
    // The camera may deliver a picture a little late: what it took before the release is no part
    // of the measurement.
    const bool counts = state == RunState::measuring && frame.t >= run_.started.value();
    if (counts) {
        if (frames_ > 0) frames_lost_ += missed;
        ++frames_;
    }
    for (const Observed& object : *observed) {
        rig_.bus.publish(bus::PoseMeasured{
            run_.rig,
            counts ? std::optional(run_.id) : std::nullopt,
            object.object,
            object.motion,
            missed});
        if (!counts) continue;
        samples_[object.object].push_back(object.track);
        end_watch_->look(object.object, object.motion);
        rig_.writer.append(
            run_.id, {object.object, object.motion}, store::FrameCounts{frames_, frames_lost_}
        );
    }
    if (!counts) return;
    if (frame.t - run_.started.value() >= from_seconds(run_.duration_s)) {
        advance(RunEvent::measured, now, "The duration is over");
    } else if (const auto reason = end_watch_->over(frame.t)) {
        advance(RunEvent::measured, now, *reason);
    }
}

void RunExecution::watch(RunState state, TimeNs now) {
    if (needs_frames(state) && now - last_frame_at_ > limits_.sensor_silence) {
        return fail_run(
            now,
            {ErrorCode::unavailable,
             "camera",
             "delivered no frame for " + lab::span_text(now - last_frame_at_)}
        );
    }
    if (auto error = rig_.writer.take_error()) {
        return fail_run(now, {ErrorCode::unavailable, "", "poses could not be stored: " + *error});
    }
    if (state == RunState::ready && run_.release_until && now >= *run_.release_until) {
        advance(RunEvent::abort, now, "Nobody released the bob in time");
    } else if (state == RunState::releasing) {
        await_release(now);
    } else if (state == RunState::analysing) {
        finish_analysis(now);
    }
}

void RunExecution::await_release(TimeNs now) {
    const auto state = rig_.device.actuator->state();
    if (!state) return fail_run(now, state.error());
    if (state->motion == ApparatusMotion::free) {
        // Seen only with the next frame, which on a busy machine comes late; and a device may tell
        // the time of the frame that it is about to take.
        const bool told = state->since && *state->since <= now + kNsPerSecond &&
                          *state->since > entered_at_ - kNsPerSecond;
        advance(RunEvent::released, told ? *state->since : now, "The actuator let the bob go");
    } else if (now - entered_at_ > limits_.release_echo) {
        fail_run(
            now,
            {ErrorCode::unavailable,
             "actuator",
             "was told to release the bob and did not within " +
                 lab::span_text(limits_.release_echo)}
        );
    }
}

void RunExecution::finish_analysis(TimeNs now) {
    if (!analysis_.valid() ||
        analysis_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        return;
    }
    const auto result = analysis_.get();
    if (!result) return fail_run(now, result.error());
    const store::StoredResult stored{
        .run = run_.id,
        .created = now,
        .result_json = result->result_json,
        .fit_json = result->fit_json,
        .plots_json = result->plots_json,
        .warnings = result->warnings,
    };
    // In the wrong state only if somebody aborted in this moment: then there is no result.
    (void)rig_.active.complete(stored, {RunEvent::analysed, now, "The result is stored", {}});
}

bool RunExecution::over() const {
    // An analysis of a run that was aborted is let go to its end, without holding up the frames.
    return over_ && (!analysis_.valid() ||
                     analysis_.wait_for(std::chrono::seconds(0)) == std::future_status::ready);
}

void RunExecution::end(RunEvent event, TimeNs now, const std::string& reason) {
    act_on_changes(now);
    if (over_) return;
    if (analysis_.valid()) {
        analysis_.wait();
        finish_analysis(now);
    }
    advance(event, now, reason);
    act_on_changes(now);
}

void RunExecution::save_frames() {
    if (std::pair(frames_, frames_lost_) == saved_frames_) return;
    rig_.active.set_frames(frames_, frames_lost_);
    saved_frames_ = {frames_, frames_lost_};
}

void RunExecution::stop_bob() {
    if (auto sent = rig_.device.actuator->stop(); !sent) trouble_ = to_text(sent.error());
}

void RunExecution::advance(RunEvent event, TimeNs now, const std::string& cause) {
    save_frames();  // first, so that whoever hears of the change finds them
    // A refusal means that somebody else has just taken the run elsewhere: the next step sees it.
    (void)rig_.active.advance({event, now, cause, {}});
}

void RunExecution::fail_run(TimeNs now, const Error& error) {
    advance(RunEvent::fail, now, to_text(error));
}

}  // namespace kinectlab::rig
