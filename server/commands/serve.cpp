#include <csignal>
#include <cstdio>

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "server/api/routes.hpp"
#include "server/api/wire.hpp"
#include "server/auth/accounts.hpp"
#include "server/commands/arguments.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/data_folder.hpp"
#include "server/config/config.hpp"
#include "server/experiments/share_dir.hpp"
#include "server/net/server.hpp"
#include "server/net/static_files.hpp"
#include "server/rig/device.hpp"

namespace kinectlab::commands {
namespace {

constexpr auto kPatience = std::chrono::seconds(4);
constexpr unsigned kLastResort_s = 10;

TimeNs now_ns() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

/// The signals that end the server; blocked in every thread, so that only wait() sees them.
class StopSignals {
public:
    StopSignals() {
        sigemptyset(&set_);
        sigaddset(&set_, SIGINT);
        sigaddset(&set_, SIGTERM);
        pthread_sigmask(SIG_BLOCK, &set_, nullptr);
        std::signal(SIGPIPE, SIG_IGN);  // a client that is gone is an error of one write
    }
    void wait() const {
        int signal = 0;
        sigwait(&set_, &signal);
    }

private:
    sigset_t set_{};
};

void log_to_stderr(const std::string& level) {
    spdlog::set_default_logger(spdlog::stderr_color_mt("kinectlab"));
    spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%eZ %^%l%$ %v", spdlog::pattern_time_type::utc);
    spdlog::set_level(spdlog::level::from_str(level));
}

std::string url_of(const config::Address& listen, std::uint16_t port) {
    const bool here = listen.host == "127.0.0.1" || listen.host == "0.0.0.0" ||
                      listen.host == "::" || listen.host == "::1";
    const bool ipv6 = listen.host.find(':') != std::string::npos;
    const std::string host = here ? "localhost" : ipv6 ? "[" + listen.host + "]" : listen.host;
    return "http://" + host + ":" + std::to_string(port);
}

/// The password goes to the terminal once and nowhere else, least of all into a log.
void greet(const std::string& url, const std::optional<auth::NewAccount>& first_admin) {
    std::printf("Kinectlab is ready: %s\n", url.c_str());
    if (first_admin) {
        std::printf(
            "First start: sign in as \"%s\" with the one-time password %s (shown only now)\n",
            first_admin->user.username.c_str(),
            first_admin->one_time_password.c_str()
        );
    }
    std::fflush(stdout);
}

std::vector<rig::RigSettings> rig_settings(
    const config::Config& config, const std::vector<experiments::Definition>& definitions
) {
    std::vector<rig::RigSettings> settings;
    for (const auto& rig : config.rigs) {
        auto ids = rig.experiments;
        if (ids.empty())
            for (const auto& definition : definitions)
                if (rig::is_simulated(rig.uri) || definition.apparatus == "pendulum")
                    ids.push_back(definition.id);
        settings.push_back({rig.id, rig.name, rig.uri, std::move(ids)});
    }
    return settings;
}

Result<void> check_experiments(
    const config::Config& config, const std::vector<experiments::Definition>& definitions
) {
    for (const auto& rig : config.rigs) {
        for (const auto& name : rig.experiments) {
            const auto found = std::find_if(
                definitions.begin(), definitions.end(), [&](const auto& d) { return d.id == name; }
            );
            if (found != definitions.end()) continue;
            return fail(
                ErrorCode::invalid_argument,
                "rigs",
                "rig " + rig.id + " names the experiment '" + name + "', which there is not",
                "give one of the definitions in " +
                    (experiments::share_dir() / "experiments").string()
            );
        }
    }
    return {};
}

/// Everything the server is made of, in the order in which it comes to life.
Result<void> run_server(const config::Config& config, const StopSignals& signals) {
    auto definitions = experiments::load_definitions(experiments::share_dir() / "experiments");
    if (!definitions) return tl::unexpected(definitions.error());
    if (auto ok = check_experiments(config, *definitions); !ok) return ok;
    if (auto ok = need_data_folder(config.data_dir); !ok) return ok;
    const auto lock = ServerLock::take(config.data_dir);
    if (!lock) return tl::unexpected(lock.error());
    const auto store = open_store(config.data_dir);

    bus::Bus bus;
    rig::ExperimentLibrary library(std::move(*definitions), store->definitions);
    rig::RigService rigs(rig_settings(config, library.built_in()), library, *store, bus);
    live::JpegCache jpegs;
    live::Hub hub(
        bus,
        {[](const lab::RigStatus& rig) { return api::to_json(rig).dump(); },
         [](const lab::Run& run) {
             return api::to_json(run).dump();
         }},
        [&rigs](const std::string& rig) { return rigs.find(rig, now_ns()); },
        jpegs
    );
    auth::SignIn sign_in(*store);
    auth::LiveTickets tickets;
    auth::LiveSessions live_sessions([&sign_in](const std::string& session) {
        return sign_in.is_open(session, now_ns());
    });
    const api::Context context{
        *store,
        rigs,
        hub,
        jpegs,
        sign_in,
        tickets,
        live_sessions,
        library,
        experiments::share_dir() / "api" / "openapi.json",
        experiments::share_dir() / "experiments" / "schema" / "experiment.schema.json",
        now_ns};
    const net::ServerSettings settings{config.listen.host, config.listen.port};
    auto server = net::Server::start(
        settings, api::routes(context), net::static_files(experiments::share_dir() / "web", "api")
    );
    if (!server) return tl::unexpected(server.error());
    greet(url_of(config.listen, (*server)->port()), auth::add_first_admin(store->users, now_ns()));

    signals.wait();
    spdlog::info("stopping: bobs to rest, runs interrupted, viewers told");
    alarm(kLastResort_s);
    rigs.shutdown();
    hub.finish();
    (*server)->stop(kPatience);
    return {};
}

}  // namespace

int serve(int argc, char** argv) {
    CLI::App app("Serve the laboratory: rigs, bookings, live view.", "kinectlab serve");
    std::string file;
    std::string data;
    std::string listen;
    app.add_option("--config", file, "JSON file with listen, data_dir, log_level, rigs");
    app.add_option("--data", data, "folder of the database (KINECTLAB_DATA_DIR)");
    app.add_option("--listen", listen, "ADDRESS:PORT (KINECTLAB_LISTEN); default 127.0.0.1:8080");
    if (const auto status = parse_arguments(app, argc, argv)) return *status;

    auto config = config::read_config(
        file.empty() ? std::nullopt : std::optional<std::filesystem::path>(file),
        config::environment()
    );
    if (!config) return report_usage(config.error());
    if (!data.empty()) config->data_dir = data;
    if (!listen.empty()) {
        const auto address = config::parse_address(listen);
        if (!address) return report_usage(address.error());
        config->listen = *address;
    }
    const StopSignals signals;
    log_to_stderr(config->log_level);
    const auto served = run_server(*config, signals);
    return served ? kOk : report(served.error());
}

}  // namespace kinectlab::commands
