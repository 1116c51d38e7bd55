#include "server/commands/output.hpp"

#include <cstdio>
#include <fstream>

#include <nlohmann/json.hpp>

namespace kinectlab::commands {

void print_json(const nlohmann::json& document) {
    const std::string text = document.dump(1, ' ', false, nlohmann::json::error_handler_t::replace);
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fputc('\n', stdout);
}

Result<void> write_text_file(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::path partial = file;
    partial += ".partial";
    std::ofstream stream(partial, std::ios::binary);
    stream << text;
    stream.close();
    std::error_code code;
    if (stream) std::filesystem::rename(partial, file, code);
    if (stream && !code) return {};
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    return fail(
        ErrorCode::unavailable,
        file.string(),
        "cannot be written",
        "name a file in a folder that you may write to"
    );
}

}  // namespace kinectlab::commands
