#include "pipeline/sensor/read_ahead.hpp"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace kinectlab {
namespace {

constexpr std::chrono::milliseconds kPatience{5000};
constexpr std::size_t kAhead = 4;  // evens out frames that take longer than others

class ReadAhead : public FrameSource {
public:
    explicit ReadAhead(std::unique_ptr<FrameSource> source)
        : source_(std::move(source)), thread_([this] { work(); }) {}
    ReadAhead(const ReadAhead&) = delete;
    ReadAhead& operator=(const ReadAhead&) = delete;
    ~ReadAhead() override {
        {
            const std::lock_guard lock(mutex_);
            over_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }

    [[nodiscard]] const SourceInfo& info() const override { return source_->info(); }

    [[nodiscard]] Result<FrameStatus> next(RgbdFrame& frame, std::chrono::milliseconds) override {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return !waiting_.empty(); });
        Taken& first = waiting_.front();
        if (first.failure) std::rethrow_exception(first.failure);
        if (first.status != FrameStatus::frame) return first.status;
        std::swap(frame, first.frame);
        used_.push_back(std::move(first.frame));
        waiting_.pop_front();
        changed_.notify_all();
        return FrameStatus::frame;
    }

private:
    struct Taken {
        Result<FrameStatus> status = FrameStatus::end;
        RgbdFrame frame;
        std::exception_ptr failure;
    };

    void work() {
        bool more = true;
        while (more) {
            Taken taken;
            {
                std::unique_lock lock(mutex_);
                changed_.wait(lock, [&] { return waiting_.size() < kAhead || over_; });
                if (over_) return;
                if (!used_.empty()) {
                    taken.frame = std::move(used_.back());
                    used_.pop_back();
                }
            }
            try {
                taken.status = source_->next(taken.frame, kPatience);
            } catch (...) {
                taken.failure = std::current_exception();
            }
            more = !taken.failure && taken.status == FrameStatus::frame;
            const std::lock_guard lock(mutex_);
            waiting_.push_back(std::move(taken));
            changed_.notify_all();
        }
    }

    std::unique_ptr<FrameSource> source_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Taken> waiting_;
    std::vector<RgbdFrame> used_;  // their buffers are filled again
    bool over_ = false;
    std::thread thread_;  // last: it needs all of the others
};

}  // namespace

std::unique_ptr<FrameSource> read_ahead(std::unique_ptr<FrameSource> source) {
    return std::make_unique<ReadAhead>(std::move(source));
}

}  // namespace kinectlab
