#include <algorithm>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/bench/measurements.hpp"
#include "tests/bench/server_client.hpp"
#include "tests/bench/server_process.hpp"

namespace kinectlab::bench {
namespace {

using nlohmann::json;

constexpr double kDuration_s = 60.0;
constexpr double kRate_hz = 30.0;

/// What one viewer saw of one run.
struct Watched {
    std::vector<double> delay_ms;  ///< from capture to the client, while the run measured
    std::int64_t missed = 0;
    json run;
};

std::string utc(std::time_t t) {
    char text[32];
    std::tm parts{};
    gmtime_r(&t, &parts);
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

void sign_in(ServerClient& client, const std::string& one_time_password) {
    const std::string password = "a password for one minute";
    client.request("POST", "/session", {{"username", "admin"}, {"password", one_time_password}});
    client.request("PUT", "/session/password", {{"current", one_time_password}, {"new", password}});
}

void wait_until_idle(ServerClient& client) {
    for (int i = 0; i < 300; ++i) {
        if (client.get("/rigs/rig-1")["state"] == "idle") return;
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    throw std::runtime_error("the rig does not become idle");
}

void book_now(ServerClient& client) {
    const std::time_t start = std::time(nullptr) / 300 * 300;
    client.request(
        "POST",
        "/bookings",
        {{"rig", "rig-1"},
         {"experiment", "pendulum"},
         {"start", utc(start)},
         {"end", utc(start + 1200)}}
    );
}

Watched watch_run(ServerClient& client) {
    book_now(client);
    const json started = client.request(
        "POST",
        "/runs",
        {{"rig", "rig-1"},
         {"experiment", "pendulum"},
         {"parameters", {{"duration_s", kDuration_s}}}}
    );
    const std::string path = "/runs/" + started["id"].dump();
    Watched watched;
    std::string state = started["state"];
    client.watch("rig-1", [&](const json& message, std::int64_t t) {
        if (message["type"] == "run") {
            watched.run = message["run"];
            const std::string next = watched.run["state"];
            if (next == "ready" && state != next)
                client.request("POST", path + "/release", nullptr);
            state = next;
        } else if (message["type"] == "pose" && state == "measuring") {
            watched.delay_ms.push_back(
                static_cast<double>(t - message["t_ns"].get<std::int64_t>()) * 1e-6
            );
            watched.missed += message["missed"].get<std::int64_t>();
        }
        return state == "preparing" || state == "ready" || state == "releasing" ||
               state == "measuring";
    });
    return watched;
}

double quantile(std::vector<double> values, double share) {
    if (values.empty()) throw std::runtime_error("no pose arrived");
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

/// The clock map lets the promptest frames arrive at their time of capture, so that the sensor's
/// own constant delay is not in the times that poses carry.
Figures measure_live_latency() {
    const ServerProcess server;
    ServerClient client(server.port());
    sign_in(client, server.one_time_password());
    wait_until_idle(client);
    const Watched watched = watch_run(client);
    const double lost = watched.run["frames_lost"].get<double>();
    const double arrived = static_cast<double>(watched.delay_ms.size());
    return {
        {"capture to pose at a WebSocket client, p99",
         quantile(watched.delay_ms, 0.99),
         "ms",
         15.0},
        {"capture to pose at a WebSocket client, median", quantile(watched.delay_ms, 0.5), "ms"},
        {"frames lost by the rig in a 60 s run", lost, "frames", 0.0},
        {"poses that the client missed in a 60 s run",
         static_cast<double>(watched.missed),
         "poses",
         0.0},
        {"poses that arrived in a 60 s run",
         arrived,
         "poses",
         kDuration_s * kRate_hz - 2,
         Better::higher},
    };
}

}  // namespace kinectlab::bench
