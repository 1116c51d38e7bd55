#include "server/net/static_files.hpp"

#include <array>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

namespace kinectlab::net {
namespace {

namespace fs = std::filesystem;

struct FileType {
    std::string_view extension;
    std::string_view content_type;
};

constexpr std::array<FileType, 16> kTypes{{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".mjs", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".json", "application/json"},
    {".map", "application/json"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".jpg", "image/jpeg"},
    {".webp", "image/webp"},
    {".ico", "image/x-icon"},
    {".woff2", "font/woff2"},
    {".txt", "text/plain; charset=utf-8"},
    {".webmanifest", "application/manifest+json"},
    {".wasm", "application/wasm"},
    {".glb", "model/gltf-binary"},
}};

std::string content_type(const fs::path& file) {
    const std::string extension = file.extension().string();
    for (const auto& type : kTypes) {
        if (type.extension == extension) return std::string(type.content_type);
    }
    return "application/octet-stream";
}

/// A segment that names one entry of a folder and nothing else.
bool is_plain_name(const std::string& segment) {
    return !segment.empty() && segment.front() != '.' &&
           segment.find_first_of("/\\") == std::string::npos;
}

/// Nothing if the address can be no file at all.
std::optional<fs::path> file_for(const fs::path& root, const std::vector<std::string>& segments) {
    const bool is_root = segments.size() == 1 && segments.front().empty();
    if (is_root) return root / "index.html";
    fs::path file = root;
    for (const auto& segment : segments) {
        if (!is_plain_name(segment)) return std::nullopt;
        file /= segment;
    }
    const bool is_page = segments.back().find('.') == std::string::npos;
    return is_page ? root / "index.html" : file;
}

struct Coding {
    std::string_view name;
    std::string_view suffix;
};
constexpr std::array<Coding, 2> kCodings{{{"br", ".br"}, {"gzip", ".gz"}}};

bool accepts(const Request& request, std::string_view coding) {
    const auto header = request.header("Accept-Encoding");
    if (!header) return false;
    const auto at = header->find(coding);
    if (at == std::string_view::npos) return false;
    return !header->substr(at + coding.size()).starts_with(";q=0");
}

std::optional<std::string> read(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return std::nullopt;
    std::ifstream stream(file, std::ios::binary);
    std::string content{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (!stream) return std::nullopt;
    return content;
}

std::string etag_of(const fs::path& file) {
    const auto changed = fs::last_write_time(file).time_since_epoch().count();
    return fmt::format("\"{:x}-{:x}\"", changed, fs::file_size(file));
}

Response serve(const Request& request, const fs::path& file, bool immutable) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return problem(404, "there is no such file");
    Response response;
    response.content_type = content_type(file);
    fs::path sent = file;
    for (const auto& coding : kCodings) {
        const fs::path packed = file.string() + std::string(coding.suffix);
        if (!accepts(request, coding.name) || !fs::is_regular_file(packed, error)) continue;
        sent = packed;
        response.headers.push_back({"Content-Encoding", std::string(coding.name)});
        break;
    }
    const std::string etag = etag_of(sent);
    response.headers.push_back({"ETag", etag});
    response.headers.push_back({"Vary", "Accept-Encoding"});
    response.headers.push_back(
        {"Cache-Control", immutable ? "public, max-age=31536000, immutable" : "no-cache"}
    );
    if (request.header("If-None-Match") == etag) {
        response.status = 304;
        return response;
    }
    auto content = read(sent);
    if (!content) return problem(404, "there is no such file");
    response.body = std::move(*content);
    return response;
}

}  // namespace

Handler static_files(std::filesystem::path root, std::string reserved) {
    return [root = std::move(root), reserved = std::move(reserved)](const Request& request) {
        const auto& segments = request.segments;
        const auto file = file_for(root, segments);
        if (!file || segments.front() == reserved) {
            return problem(404, "there is nothing at this address");
        }
        return serve(request, *file, segments.front() == "assets");
    };
}

}  // namespace kinectlab::net
