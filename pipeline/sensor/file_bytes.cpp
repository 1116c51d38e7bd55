#include "pipeline/sensor/file_bytes.hpp"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

namespace kinectlab {
namespace {

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

}  // namespace

Result<void> read_file(
    const std::filesystem::path& path, std::size_t max_bytes, std::vector<std::uint8_t>& bytes
) {
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code)) {
        return fail(
            ErrorCode::not_found, path.string(), "is not there, or not a file", "put the file there"
        );
    }
    const auto size = std::filesystem::file_size(path, code);
    if (code || size > max_bytes) {
        return fail(
            ErrorCode::bad_data,
            path.string(),
            "has " + std::to_string(size) + " bytes",
            "give a file of at most " + std::to_string(max_bytes) + " bytes"
        );
    }
    bytes.resize(size);
    const File file(std::fopen(path.c_str(), "rb"));
    if (!file || std::fread(bytes.data(), 1, size, file.get()) != size) {
        return fail(
            ErrorCode::bad_data,
            path.string(),
            "could not be read",
            "check its permissions and the disk"
        );
    }
    return {};
}

void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
    File file(std::fopen(path.c_str(), "wb"));
    const bool written =
        file && std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
    if (!written || std::fclose(file.release()) != 0) {
        throw std::system_error(errno, std::generic_category(), "cannot write " + path.string());
    }
}

}  // namespace kinectlab
