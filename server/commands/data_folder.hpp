#pragma once

#include <filesystem>
#include <memory>

#include "pipeline/core/error.hpp"
#include "server/store/store.hpp"

namespace kinectlab::commands {

/// Makes the folder, readable by its owner only, if it is not there.
[[nodiscard]] Result<void> need_data_folder(const std::filesystem::path& folder);

/// For what only looks: error `not_found` where no laboratory has put its database, so that a
/// misspelt folder does not become one.
[[nodiscard]] Result<void> need_database(const std::filesystem::path& folder);

/// The laboratory's database in that folder. Throws store::StoreError.
[[nodiscard]] std::unique_ptr<store::Store> open_store(const std::filesystem::path& folder);

/// Held by the one server of a data folder; the kernel lets go of it when the process ends, however
/// it ends.
class ServerLock {
public:
    /// Error `conflict` if another server has it.
    [[nodiscard]] static Result<ServerLock> take(const std::filesystem::path& folder);

    ServerLock(ServerLock&& other) noexcept;
    ServerLock& operator=(ServerLock&&) = delete;
    ~ServerLock();

private:
    explicit ServerLock(int file) : file_(file) {}
    int file_;
};

}  // namespace kinectlab::commands
