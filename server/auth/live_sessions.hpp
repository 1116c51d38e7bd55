#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace kinectlab::auth {

/// Open streams end with the session that opened them, however that ended: signed out, a new
/// password (also from the command line, by another process), or its time was over. The sessions
/// are looked up on a thread of its own, so that no stream waits for the disk. Thread-safe.
class LiveSessions {
public:
    /// Whether the session with this token's hash is open.
    using IsOpen = std::function<bool(const std::string& token_hash)>;

    /// One open stream; whoever sends on it asks whether it is over.
    class Stream {
    public:
        explicit Stream(std::string session) : session_(std::move(session)) {}
        [[nodiscard]] bool over() const { return over_; }

    private:
        friend class LiveSessions;
        const std::string session_;
        std::atomic<bool> over_{false};
    };

    explicit LiveSessions(IsOpen is_open);
    ~LiveSessions();
    LiveSessions(const LiveSessions&) = delete;
    LiveSessions& operator=(const LiveSessions&) = delete;

    /// Watched for as long as somebody holds it.
    [[nodiscard]] std::shared_ptr<const Stream> watch(const std::string& token_hash);

    /// A session has just ended: look now, not only within the second.
    void look();

private:
    void work();
    void check(const std::vector<std::shared_ptr<Stream>>& streams) const;

    const IsOpen is_open_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<std::weak_ptr<Stream>> streams_;
    bool asked_ = false;
    bool closing_ = false;
    std::thread thread_;  // last: it uses all the others
};

}  // namespace kinectlab::auth
