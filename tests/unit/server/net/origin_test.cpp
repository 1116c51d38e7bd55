#include "server/net/origin.hpp"

#include <gtest/gtest.h>

namespace kinectlab::net {
namespace {

bool allowed(std::vector<Header> headers) {
    Request request;
    request.headers = std::move(headers);
    return same_origin(request);
}

TEST(SameOrigin, ComparesHostAndPort) {
    EXPECT_TRUE(allowed({{"Host", "lab:8080"}}));
    EXPECT_TRUE(allowed({{"Host", "lab:8080"}, {"Origin", "http://lab:8080"}}));
    EXPECT_TRUE(allowed({{"Host", "lab"}, {"Origin", "https://lab"}}));
    for (const char* origin :
         {"http://lab",
          "http://lab:80801",
          "http://evil",
          "null",
          "",
          "file://lab:8080",
          "http://evil/lab:8080",
          "http://lab:8080.evil"})
        EXPECT_FALSE(allowed({{"Host", "lab:8080"}, {"Origin", origin}})) << origin;
    EXPECT_FALSE(allowed({{"Origin", "http://"}}));
}

}  // namespace
}  // namespace kinectlab::net
