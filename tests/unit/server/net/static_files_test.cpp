#include "server/net/static_files.hpp"

#include <fstream>

#include <gtest/gtest.h>

namespace kinectlab::net {
namespace {

namespace fs = std::filesystem;

class StaticFiles : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "kinectlab-static-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
        write("secret.txt", "secret");
        write("web/index.html", "the page");
        write("web/assets/app-1a2b.js", "script");
        write("web/assets/app-1a2b.js.br", "packed");
        handler_ = static_files(folder_ / "web", "api");
    }
    void TearDown() override { fs::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
    }
    Response get(const std::string& path, std::vector<Header> headers = {}) const {
        Request request;
        request.segments = parse_target(path)->segments;
        request.headers = std::move(headers);
        return handler_(request);
    }
    static std::string header(const Response& response, const std::string& name) {
        for (const auto& header : response.headers) {
            if (header.name == name) return header.value;
        }
        return "";
    }

    fs::path folder_;
    Handler handler_;
};

TEST_F(StaticFiles, PagesOfTheClientGetTheIndex) {
    EXPECT_EQ(get("/").body, "the page");
    EXPECT_EQ(get("/runs/12").body, "the page");
    EXPECT_EQ(get("/runs/12").content_type, "text/html; charset=utf-8");
    EXPECT_EQ(header(get("/"), "Cache-Control"), "no-cache");
}

TEST_F(StaticFiles, WhatIsNotThereIsNotFound) {
    EXPECT_EQ(get("/missing.js").status, 404);
    EXPECT_EQ(get("/api/v1/missing").status, 404);
    EXPECT_EQ(get("/api").status, 404);
}

TEST_F(StaticFiles, HashedFilesNeverChangeAndArePackedForThoseWhoTakeIt) {
    const Response plain = get("/assets/app-1a2b.js");
    EXPECT_EQ(plain.body, "script");
    EXPECT_EQ(header(plain, "Cache-Control"), "public, max-age=31536000, immutable");
    const Response packed = get("/assets/app-1a2b.js", {{"Accept-Encoding", "gzip, br"}});
    EXPECT_EQ(packed.body, "packed");
    EXPECT_EQ(packed.content_type, "text/javascript; charset=utf-8");
    EXPECT_EQ(header(packed, "Content-Encoding"), "br");
    EXPECT_EQ(get("/assets/app-1a2b.js", {{"Accept-Encoding", "br;q=0"}}).body, "script");
}

TEST_F(StaticFiles, AnUnchangedFileIsNotSentAgain) {
    const std::string etag = header(get("/"), "ETag");
    ASSERT_FALSE(etag.empty());
    const Response again = get("/", {{"If-None-Match", etag}});
    EXPECT_EQ(again.status, 304);
    EXPECT_EQ(again.body, "");
    EXPECT_EQ(get("/", {{"If-None-Match", "\"other\""}}).status, 200);
}

TEST_F(StaticFiles, NoAddressLeadsOut) {
    for (const char* path :
         {"/../secret.txt",
          "/%2e%2e/secret.txt",
          "/..%2fsecret.txt",
          "/assets/..%5c..%5csecret.txt",
          "//secret.txt",
          "/./secret.txt",
          "/.hidden.txt"})
        EXPECT_EQ(get(path).status, 404) << path;
}

}  // namespace
}  // namespace kinectlab::net
