#include "server/rig/active_run.hpp"

namespace kinectlab::rig {
namespace {

tl::unexpected<Error> no_run() {
    return fail(ErrorCode::conflict, "state", "the run is over", "start a new run");
}

}  // namespace

void ActiveRun::begin(const lab::Run& run) {
    const std::lock_guard lock(mutex_);
    run_ = run;
    bus_.publish(bus::RunChanged{run});
}

std::optional<lab::Run> ActiveRun::current() const {
    const std::lock_guard lock(mutex_);
    return run_;
}

Result<lab::Run> ActiveRun::advance(const store::RunStep& step) {
    const std::lock_guard lock(mutex_);
    if (!run_) return no_run();
    return advance_locked(step);
}

Result<lab::Run> ActiveRun::advance(lab::RunId id, const store::RunStep& step) {
    const std::lock_guard lock(mutex_);
    if (!run_ || run_->id != id) return no_run();
    return advance_locked(step);
}

Result<lab::Run> ActiveRun::complete(
    const store::StoredResult& result, const store::RunStep& step
) {
    const std::lock_guard lock(mutex_);
    if (!run_) return no_run();
    store::Database::Transaction transaction(store_.database);
    store_.results.add(result);
    auto changed = store_.runs.advance(run_->id, step);
    if (!changed) return changed;
    transaction.commit();
    reread_and_publish(run_->id);
    return *run_;
}

void ActiveRun::set_frames(std::int64_t frames, std::int64_t lost) {
    const std::lock_guard lock(mutex_);
    if (!run_) return;
    store_.runs.set_frames(run_->id, frames, lost);
    reread_and_publish(run_->id);
}

void ActiveRun::clear() {
    const std::lock_guard lock(mutex_);
    run_.reset();
}

Result<lab::Run> ActiveRun::advance_locked(const store::RunStep& step) {
    auto changed = store_.runs.advance(run_->id, step);
    if (!changed) return changed;
    run_ = *changed;
    bus_.publish(bus::RunChanged{*run_});
    return *run_;
}

void ActiveRun::reread_and_publish(lab::RunId id) {
    run_ = store_.runs.find(id);
    bus_.publish(bus::RunChanged{*run_});
}

}  // namespace kinectlab::rig
