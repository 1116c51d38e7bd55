#include "server/commands/data_folder.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "server/experiments/share_dir.hpp"

namespace kinectlab::commands {
namespace {

constexpr const char* kDatabase = "kinectlab.sqlite";

Error cannot_use(const std::filesystem::path& folder, const std::string& why) {
    return {
        ErrorCode::unavailable,
        "data_dir",
        "cannot use " + folder.string() + ": " + why,
        "give a folder that this program may write with --data"};
}

}  // namespace

Result<void> need_data_folder(const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    std::error_code error;
    const bool made = fs::create_directories(folder, error);
    if (error) return tl::unexpected(cannot_use(folder, error.message()));
    if (made) fs::permissions(folder, fs::perms::owner_all, error);
    if (access(folder.c_str(), W_OK) != 0) {
        return tl::unexpected(cannot_use(folder, std::strerror(errno)));
    }
    return {};
}

Result<void> need_database(const std::filesystem::path& folder) {
    std::error_code error;
    if (std::filesystem::is_regular_file(folder / kDatabase, error)) return {};
    return fail(
        ErrorCode::not_found,
        "data_dir",
        "there is no database in " + folder.string(),
        "give the folder that `serve` uses with --data"
    );
}

std::unique_ptr<store::Store> open_store(const std::filesystem::path& folder) {
    return std::make_unique<store::Store>(
        folder / kDatabase, experiments::share_dir() / "migrations"
    );
}

Result<ServerLock> ServerLock::take(const std::filesystem::path& folder) {
    const auto path = folder / "server.lock";
    const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (file < 0) return tl::unexpected(cannot_use(folder, std::strerror(errno)));
    if (flock(file, LOCK_EX | LOCK_NB) == 0) return ServerLock(file);
    close(file);
    return fail(
        ErrorCode::conflict,
        "data_dir",
        folder.string() + " is in use by another server",
        "stop that one, or give another folder with --data"
    );
}

ServerLock::ServerLock(ServerLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

ServerLock::~ServerLock() {
    if (file_ >= 0) close(file_);
}

}  // namespace kinectlab::commands
