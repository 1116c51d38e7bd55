#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "pipeline/core/error.hpp"

namespace kinectlab::experiments {

/// A JSON file of at most 1 MiB. Errors name the file; those of syntax also the line and column.
[[nodiscard]] Result<nlohmann::json> read_json_file(const std::filesystem::path& file);

/// Refuses syntax errors and a key given twice in one object, which the library would let pass.
[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text, const std::string& name);

/// Reads the members of one JSON object, each exactly once; the first error is kept, later calls
/// then do nothing, so that a reader can be written straight down and asked once at the end.
class ObjectReader {
public:
    /// `path` is put before the keys in errors, e.g. "objects[0]". Keys not among `keys` are errors
    /// that name the nearest valid one.
    ObjectReader(const nlohmann::json& json, std::string path, std::vector<std::string> keys);

    [[nodiscard]] bool has(const std::string& key) const;
    [[nodiscard]] std::string text(const std::string& key);
    [[nodiscard]] double number(const std::string& key);
    [[nodiscard]] double number_or(const std::string& key, double otherwise);
    [[nodiscard]] std::string text_or(const std::string& key, const std::string& otherwise);
    /// None where the key is missing or null.
    [[nodiscard]] std::optional<double> optional_number(const std::string& key);
    [[nodiscard]] bool flag_or(const std::string& key, bool otherwise);
    /// An array, possibly empty; an empty one after an error.
    [[nodiscard]] const nlohmann::json& array(const std::string& key);

    [[nodiscard]] std::string path_of(const std::string& key) const;
    void refuse(const std::string& key, std::string message, std::string cure);
    [[nodiscard]] bool ok() const { return !error_.has_value(); }
    /// The first error; only to be called if there is one.
    [[nodiscard]] tl::unexpected<Error> error() const { return tl::unexpected<Error>(*error_); }

private:
    const nlohmann::json* member(const std::string& key, const std::string& cure);

    const nlohmann::json& json_;
    std::string path_;
    std::optional<Error> error_;
};

}  // namespace kinectlab::experiments
