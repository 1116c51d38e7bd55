#include "server/api/problem.hpp"

#include <nlohmann/json.hpp>

namespace kinectlab::api {
namespace {

using nlohmann::json;

int status_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::invalid_argument:
            return 422;
        case ErrorCode::bad_data:
            return 400;
        case ErrorCode::not_found:
            return 404;
        case ErrorCode::conflict:
            return 409;
        case ErrorCode::forbidden:
            return 403;
        case ErrorCode::unavailable:
            return 503;
    }
    return 500;
}

/// What a person gave may hold anything; what is no UTF-8 is replaced.
std::string dump(const json& document) {
    return document.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

net::Response to_response(int status, const Error& error, const json& more) {
    json document = {
        {"type", "about:blank"},
        {"title", net::reason_phrase(status)},
        {"status", status},
        {"detail", to_text(error)}};
    if (!error.field.empty()) {
        document["errors"] =
            json::array({{{"field", error.field}, {"message", error.message}, {"cure", error.cure}}}
            );
    }
    document.update(more);
    net::Response response;
    response.status = status;
    response.content_type = "application/problem+json";
    response.body = dump(document);
    response.headers = {{"Cache-Control", "no-store"}};
    return response;
}

net::Response to_response(int status, const Error& error) {
    return to_response(status, error, json::object());
}

net::Response to_response(const Error& error) {
    return to_response(status_of(error.code), error);
}

net::Response problem(int status, std::string message, std::string cure) {
    return to_response(status, Error{{}, "", std::move(message), std::move(cure)});
}

}  // namespace kinectlab::api
