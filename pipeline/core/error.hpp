#pragma once

#include <string>

#include <tl/expected.hpp>

namespace kinectlab {

enum class ErrorCode {
    invalid_argument,  ///< A value that a person gave is not acceptable.
    bad_data,          ///< A file or a stream is damaged or not what it claims to be.
    not_found,         ///< The named thing does not exist.
    conflict,          ///< Right in itself, but not together with what is there already.
    forbidden,         ///< Somebody else may do this.
    unavailable,       ///< Could work later: a device is off, a rig is busy.
};

/// What was wrong with an input and what would be right; broken dependencies throw instead.
struct Error {
    ErrorCode code = ErrorCode::invalid_argument;
    std::string field;    ///< The parameter, JSON path or file concerned; empty if none.
    std::string message;  ///< What was wrong, with the value seen.
    std::string cure;     ///< What would be right.
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(
    ErrorCode code, std::string field, std::string message, std::string cure = {}
) {
    return tl::unexpected<Error>(Error{code, std::move(field), std::move(message), std::move(cure)}
    );
}

/// One line for a terminal: "length_m: is -1; give a number from 0.1 to 3".
inline std::string to_text(const Error& error) {
    std::string text = error.field.empty() ? error.message : error.field + ": " + error.message;
    if (!error.cure.empty()) text += "; " + error.cure;
    return text;
}

}  // namespace kinectlab
