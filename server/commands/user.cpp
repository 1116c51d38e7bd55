#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "server/api/wire.hpp"
#include "server/auth/accounts.hpp"
#include "server/commands/arguments.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/data_folder.hpp"
#include "server/commands/output.hpp"
#include "server/config/config.hpp"

namespace kinectlab::commands {
namespace {

struct Arguments {
    std::string data;
    std::string username;
    std::string display_name;
    std::string role = "student";
};

TimeNs now_ns() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

int print(const Result<auth::NewAccount>& account) {
    if (!account) return report(account.error());
    print_json(api::to_json(*account));
    return kOk;
}

/// Checked before the database is opened, which may make it: a refusal leaves nothing behind.
Result<lab::Role> check(const Arguments& arguments) {
    const auto role = lab::role_from_text(arguments.role);
    if (!role) {
        return fail(
            ErrorCode::invalid_argument,
            "--role",
            "is '" + arguments.role + "'",
            "give student, assistant, instructor, staff or admin"
        );
    }
    if (auto ok = auth::check_names(arguments.username, arguments.display_name); !ok)
        return tl::unexpected(ok.error());
    return *role;
}

int add(store::Store& store, const Arguments& arguments, lab::Role role) {
    return print(
        auth::add_account(store.users, arguments.username, arguments.display_name, role, now_ns())
    );
}

int list(store::Store& store) {
    nlohmann::json users = nlohmann::json::array();
    for (const auto& user : store.users.all())
        users.push_back(api::to_json(user));
    print_json({{"users", users}});
    return kOk;
}

}  // namespace

/// Works on the database directly, also while a server runs on it.
int user(int argc, char** argv) {
    CLI::App app("Add and list people, reset passwords.", "kinectlab user");
    Arguments arguments;
    app.require_subcommand(1);
    app.fallthrough();
    app.add_option("--data", arguments.data, "folder of the database (KINECTLAB_DATA_DIR)");
    auto* const to_add = app.add_subcommand("add", "add a person; prints a one-time password");
    to_add->add_option("NAME", arguments.username, "user name")->required();
    to_add->add_option(
        "--role", arguments.role, "student | assistant | instructor | staff | admin"
    );
    to_add->add_option("--name", arguments.display_name, "what others read; default: NAME");
    const auto* const to_list = app.add_subcommand("list", "list everybody");
    auto* const to_reset = app.add_subcommand("reset", "give a new one-time password");
    to_reset->add_option("NAME", arguments.username, "user name")->required();
    if (const auto status = parse_arguments(app, argc, argv)) return *status;

    const auto config = config::read_config(std::nullopt, config::environment());
    if (!config) return report_usage(config.error());
    const std::filesystem::path folder =
        arguments.data.empty() ? config->data_dir : std::filesystem::path(arguments.data);
    if (to_add->parsed()) {
        if (arguments.display_name.empty()) arguments.display_name = arguments.username;
        const auto role = check(arguments);
        if (!role) return report_usage(role.error());
        if (auto ok = need_data_folder(folder); !ok) return report(ok.error());
        return add(*open_store(folder), arguments, *role);
    }
    if (auto ok = need_database(folder); !ok) return report(ok.error());
    const auto store = open_store(folder);
    if (to_list->parsed()) return list(*store);
    return print(auth::reset_password(store->users, arguments.username));
}

}  // namespace kinectlab::commands
