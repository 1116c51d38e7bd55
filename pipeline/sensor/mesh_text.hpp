#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "pipeline/sensor/mesh_file.hpp"

namespace kinectlab::mesh {

/// Walks through a file line by line and a line word by word, without copying.
class Text {
public:
    explicit Text(std::span<const std::uint8_t> file)
        : text_(reinterpret_cast<const char*>(file.data()), file.size()) {}

    /// False at the end of the file. The line comes without its end.
    bool next_line(std::string_view& line) {
        if (at_ >= text_.size()) return false;
        const auto end = std::min(text_.find('\n', at_), text_.size());
        line = text_.substr(at_, end - at_);
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        at_ = end + 1;
        ++number_;
        return true;
    }

    /// The byte after the last line.
    [[nodiscard]] std::size_t position() const { return std::min(at_, text_.size()); }
    [[nodiscard]] std::size_t line_number() const { return number_; }

private:
    std::string_view text_;
    std::size_t at_ = 0;
    std::size_t number_ = 0;
};

/// Takes the first word off `line`; empty at its end.
inline std::string_view take_word(std::string_view& line) {
    constexpr std::string_view kSpaces = " \t\v\f\r";
    const auto start = std::min(line.find_first_not_of(kSpaces), line.size());
    const auto end = std::min(line.find_first_of(kSpaces, start), line.size());
    const auto word = line.substr(start, end - start);
    line.remove_prefix(end);
    return word;
}

/// A number that takes the whole word; "nan" and "inf" are numbers, an empty word is none.
template <class T>
std::optional<T> to_number(std::string_view word) {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    T value{};
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || word.empty()) return std::nullopt;
    if (code == std::errc::result_out_of_range) {  // 1e-50 as a float is 0, 1e50 is no number
        if constexpr (std::is_same_v<T, float>)
            if (const auto wide = to_number<double>(word)) return static_cast<float>(*wide);
        return std::nullopt;
    }
    return code == std::errc() ? std::optional(value) : std::nullopt;
}

inline tl::unexpected<Error> bad_line(
    const std::string& name, std::size_t line, std::string message, std::string cure
) {
    return fail(
        ErrorCode::bad_data, name + ":" + std::to_string(line), std::move(message), std::move(cure)
    );
}

/// At most 40 bytes of a word, printable, for an error.
inline std::string shown(std::string_view word) {
    std::string text = "\"";
    for (const char c : word.substr(0, 40))
        text += c >= ' ' && c <= '~' ? c : '?';
    return text + "\"";
}

/// Drops what is not finite, triangles without area or with an index beyond the vertices' end.
/// An error if no point is left.
[[nodiscard]] Result<MeshFile> tidied(TriangleMesh mesh, const std::string& name);

}  // namespace kinectlab::mesh
