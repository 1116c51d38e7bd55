#include "server/config/config.hpp"

#include <fstream>

#include <gtest/gtest.h>

namespace kinectlab::config {
namespace {

namespace fs = std::filesystem;

Result<Config> read(const std::string& text, const Environment& environment = {}) {
    const fs::path file =
        fs::temp_directory_path() / ("kinectlab-config-" + std::to_string(getpid()));
    std::ofstream(file) << text;
    auto config = read_config(file, environment);
    fs::remove(file);
    return config;
}

TEST(ReadConfig, HasTwoSimulatedRigsByDefault) {
    const auto config = read_config(std::nullopt, {{"HOME", "/home/ada"}});
    ASSERT_TRUE(config);
    ASSERT_EQ(config->rigs.size(), 2U);
    EXPECT_EQ(config->rigs[0].id, "rig-1");
    EXPECT_EQ(config->listen.host, "127.0.0.1");
    EXPECT_EQ(config->listen.port, 8080);
    EXPECT_EQ(config->data_dir, "/home/ada/.local/share/kinectlab");
}

TEST(ReadConfig, EnvironmentWinsOverFileOverDefaults) {
    const auto config = read(
        R"({"listen":"0.0.0.0:1","data_dir":"/a","rigs":[{"id":"x","uri":"sim://x"}]})",
        {{"KINECTLAB_LISTEN", "[::1]:2"}, {"KINECTLAB_BIN", "of a test"}}
    );
    ASSERT_TRUE(config) << to_text(config.error());
    EXPECT_EQ(config->listen.host, "::1");
    EXPECT_EQ(config->listen.port, 2);
    EXPECT_EQ(config->data_dir, "/a");
    ASSERT_EQ(config->rigs.size(), 1U);
    EXPECT_EQ(config->rigs[0].name, "x");
    EXPECT_TRUE(config->rigs[0].experiments.empty());  // all that it can do
}

TEST(ReadConfig, ErrorsNameTheKeyAndTheNearestValidOne) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {R"({"lisen":"x"})", "lisen"},
        {R"({"listen":"x"})", "listen"},
        {R"({"listen":8080})", "listen"},
        {R"({"log_level":"loud"})", "log_level"},
        {R"({"rigs":[]})", "rigs"},
        {R"({"rigs":[{"id":"A","uri":"u"}]})", "rigs[0].id"},
        {R"({"rigs":[{"id":"a"}]})", "rigs[0].uri"},
        {R"({"rigs":[{"id":"a","uri":"u"},{"id":"a","uri":"v"}]})", "rigs[1].id"},
        {R"({"rigs":[{"id":"a","uri":"u","speed":1}]})", "rigs[0].speed"},
    };
    for (const auto& [text, field] : cases) {
        const auto config = read(text);
        ASSERT_FALSE(config) << text;
        EXPECT_EQ(config.error().field, field);
    }
    EXPECT_NE(read(R"({"lisen":"x"})").error().cure.find("listen"), std::string::npos);
    EXPECT_FALSE(read_config("/no/such/file", {}));
    const auto slip = read_config(std::nullopt, {{"KINECTLAB_DATA_DRI", "x"}});
    ASSERT_FALSE(slip);
    EXPECT_EQ(slip.error().cure, "did you mean KINECTLAB_DATA_DIR?");
}

TEST(ParseAddress, TakesHostAndPort) {
    EXPECT_EQ(parse_address(":80")->host, "127.0.0.1");
    EXPECT_EQ(parse_address("localhost:80")->host, "127.0.0.1");
    EXPECT_EQ(parse_address("[fe80::1]:0")->host, "fe80::1");
    for (const char* text : {"", "8080", "a:", "a:b", "a:70000", "a:-1", "::1:80", "a:80x"})
        EXPECT_FALSE(parse_address(text)) << text;
}

}  // namespace
}  // namespace kinectlab::config
