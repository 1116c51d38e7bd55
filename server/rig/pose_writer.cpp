#include "server/rig/pose_writer.hpp"

#include <chrono>

namespace kinectlab::rig {
namespace {

constexpr std::chrono::milliseconds kBatch{500};

}  // namespace

PoseWriter::PoseWriter(store::PoseRepository& poses, std::size_t limit)
    : poses_(poses), limit_(limit), thread_([this] { work(); }) {}

PoseWriter::~PoseWriter() {
    {
        const std::lock_guard lock(mutex_);
        closing_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void PoseWriter::append(
    lab::RunId run, store::StoredPose pose, std::optional<store::FrameCounts> so_far
) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return waiting_.size() < limit_; });
    waiting_.push_back({run, std::move(pose), so_far});
    if (waiting_.size() == limit_) changed_.notify_all();
}

void PoseWriter::flush() {
    std::unique_lock lock(mutex_);
    hurry_ = true;
    changed_.notify_all();
    changed_.wait(lock, [&] { return waiting_.empty() && !storing_; });
    hurry_ = false;
}

std::optional<std::string> PoseWriter::take_error() {
    const std::lock_guard lock(mutex_);
    return std::exchange(error_, std::nullopt);
}

void PoseWriter::work() {
    std::unique_lock lock(mutex_);
    while (!closing_ || !waiting_.empty()) {
        changed_.wait_for(lock, kBatch, [&] {
            return closing_ || (hurry_ && !waiting_.empty()) || waiting_.size() >= limit_;
        });
        std::vector<Waiting> batch;
        batch.swap(waiting_);
        storing_ = true;
        lock.unlock();
        changed_.notify_all();
        std::optional<std::string> error;
        try {
            store(batch);
        } catch (const std::exception& broken) {
            error = broken.what();
        }
        lock.lock();
        storing_ = false;
        if (error) error_ = std::move(error);
        changed_.notify_all();
    }
}

void PoseWriter::store(const std::vector<Waiting>& batch) {
    // One transaction for each run in the batch; nearly always there is only one.
    for (std::size_t begin = 0; begin < batch.size();) {
        std::vector<store::StoredPose> poses;
        const lab::RunId run = batch[begin].run;
        while (begin < batch.size() && batch[begin].run == run)
            poses.push_back(batch[begin++].pose);
        poses_.append(run, poses, batch[begin - 1].so_far);
    }
}

}  // namespace kinectlab::rig
