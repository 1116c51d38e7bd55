#include "server/net/router.hpp"

#include <gtest/gtest.h>

namespace kinectlab::net {
namespace {

Handler answers(const std::string& text) {
    return [text](const Request&) {
        return Response{200, "text/plain", text};
    };
}

Router make_router(Handler fallback = {}) {
    std::vector<Route> routes;
    routes.push_back({Method::get, "/rigs", answers("list")});
    routes.push_back({Method::post, "/rigs", answers("add")});
    routes.push_back({Method::get, "/rigs/{rig}/runs/{run}", answers("run")});
    return {std::move(routes), std::move(fallback)};
}

Request request_of(Method method, const std::string& path) {
    Request request;
    request.method = method;
    request.segments = parse_target(path)->segments;
    return request;
}

std::string found(const Router& router, Request& request) {
    const auto result = router.find(request);
    if (const auto* response = std::get_if<Response>(&result)) {
        return std::to_string(response->status);
    }
    return (*std::get<const Handler*>(result))(request).body;
}

TEST(Router, FindsByMethodAndFillsParameters) {
    const Router router = make_router();
    Request request = request_of(Method::get, "/rigs/rig-1/runs/7");
    EXPECT_EQ(found(router, request), "run");
    EXPECT_EQ(request.parameters.at("rig"), "rig-1");
    EXPECT_EQ(request.parameters.at("run"), "7");
    request = request_of(Method::head, "/rigs");
    EXPECT_EQ(found(router, request), "list");
}

TEST(Router, AnEmptySegmentIsNoParameter) {
    const Router router = make_router();
    Request request = request_of(Method::get, "/rigs//runs/7");
    EXPECT_EQ(found(router, request), "404");
}

TEST(Router, AnotherMethodIsToldWhatWouldDo) {
    const Router router = make_router();
    Request request = request_of(Method::del, "/rigs");
    const auto result = router.find(request);
    const auto& response = std::get<Response>(result);
    EXPECT_EQ(response.status, 405);
    const auto& allow = response.headers.back();
    EXPECT_EQ(allow.name + ": " + allow.value, "Allow: GET, HEAD, POST");
}

TEST(Router, FallsBackForGetOnly) {
    const Router router = make_router(answers("file"));
    Request get = request_of(Method::get, "/index.html");
    EXPECT_EQ(found(router, get), "file");
    Request post = request_of(Method::post, "/index.html");
    EXPECT_EQ(found(router, post), "405");
}

}  // namespace
}  // namespace kinectlab::net
