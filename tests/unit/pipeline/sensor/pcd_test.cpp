#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "pipeline/sensor/lzf.hpp"
#include "pipeline/sensor/pcd_file.hpp"
#include "pipeline/sensor/recording.hpp"
#include "tests/unit/pipeline/sensor/scratch_folder.hpp"

namespace kinectlab {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

std::span<const std::uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string header(const std::string& data, int width = 2, int height = 2) {
    return "# .PCD v0.7\nVERSION 0.7\nFIELDS rgba z x label y\nSIZE 4 4 4 4 4\nTYPE U F F U F\n"
           "COUNT 1 1 1 1 1\nWIDTH " +
           std::to_string(width) + "\nHEIGHT " + std::to_string(height) +
           "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(width * height) + "\nDATA " +
           data + "\n";
}

template <class T>
void put(std::string& out, T value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

const float kZ[] = {1.0F, std::nanf(""), 2.5F, 0.75F};
const std::uint32_t kRgba[] = {0xFF102030, 0, 0x00FFFFFF, 0x80000001};

// Literal runs only: what any decoder of LZF must take.
std::string as_literals(const std::string& plain) {
    std::string out;
    for (std::size_t i = 0; i < plain.size(); i += 32) {
        const std::string run = plain.substr(i, 32);
        out += static_cast<char>(run.size() - 1);
        out += run;
    }
    return out;
}

std::string binary() {
    std::string data;
    for (std::size_t i = 0; i < 4; ++i) {
        put(data, kRgba[i]);
        put(data, kZ[i]);
        put(data, static_cast<float>(i));
        put(data, std::uint32_t{7});
        put(data, -static_cast<float>(i));
    }
    return header("binary") + data;
}

std::string compressed() {
    std::string data;
    for (const auto v : kRgba)
        put(data, v);
    for (const auto v : kZ)
        put(data, v);
    for (int i = 0; i < 4; ++i)
        put(data, static_cast<float>(i));
    for (int i = 0; i < 4; ++i)
        put(data, std::uint32_t{7});
    for (int i = 0; i < 4; ++i)
        put(data, -static_cast<float>(i));
    const std::string packed = as_literals(data);
    std::string file = header("binary_compressed");
    put(file, static_cast<std::uint32_t>(packed.size()));
    put(file, static_cast<std::uint32_t>(data.size()));
    return file + packed;
}

std::string ascii() {
    return header("ascii") +
           "4279246896 1.0 0 7 -0\n0 nan 1 7 -1\r\n16777215 2.5 2 7 -2\n2147483649 0.75 3 7 -3\n";
}

class PcdKinds : public testing::TestWithParam<std::string> {};

TEST_P(PcdKinds, HoldTheSameCloud) {
    const auto cloud = parse_pcd(bytes_of(GetParam()), "a.pcd");
    ASSERT_TRUE(cloud) << to_text(cloud.error());
    EXPECT_EQ(cloud->width, 2);
    EXPECT_EQ(cloud->height, 2);
    EXPECT_EQ(cloud->z[0], 1.0F);
    EXPECT_TRUE(std::isnan(cloud->z[1]));
    EXPECT_EQ(cloud->z[3], 0.75F);
    EXPECT_EQ(cloud->x[3], 3.0F);
    EXPECT_EQ(cloud->y[2], -2.0F);
    const std::vector<std::uint8_t> rgb = {0x10, 0x20, 0x30, 0, 0, 0, 255, 255, 255, 0, 0, 1};
    EXPECT_EQ(cloud->rgb, rgb);
}

TEST_P(PcdKinds, AreRefusedWhenCutShortAnywhere) {
    const std::string whole = GetParam();
    const bool is_ascii = whole.find("DATA ascii") != std::string::npos;
    // The last digits of a text may go missing unnoticed, its last number not.
    const std::size_t end = whole.size() - (is_ascii ? 4 : 1);
    for (std::size_t length = 0; length < end; ++length)
        EXPECT_FALSE(parse_pcd(bytes_of(whole.substr(0, length)), "a.pcd")) << length;
}

INSTANTIATE_TEST_SUITE_P(All, PcdKinds, testing::Values(ascii(), binary(), compressed()));

TEST(Pcd, RefusesWhatIsNoOrganisedCloud) {
    const auto error = [](const std::string& text) {
        const auto cloud = parse_pcd(bytes_of(text), "a.pcd");
        return cloud ? std::string("none") : to_text(cloud.error());
    };
    EXPECT_THAT(error(header("ascii", 4, 1)), HasSubstr("not organised"));
    EXPECT_THAT(error(header("ascii", 5000, 2)), HasSubstr("4096"));
    EXPECT_THAT(error(header("ascii", 0, 1)), HasSubstr("is empty"));
    EXPECT_THAT(error(header("ascii", 0, 0)), HasSubstr("leave the file out"));
    EXPECT_THAT(error("hello"), HasSubstr("header"));
    EXPECT_THAT(error(header("zip")), HasSubstr("a.pcd:11"));
    std::string without_z = binary();
    without_z.replace(without_z.find(" z "), 3, " w ");
    EXPECT_THAT(error(without_z), HasSubstr("field z"));
}

TEST(Pcd, AClaimOfMuchDataTakesNoMemory) {
    std::string file = header("binary_compressed", 4096, 4096);
    put(file, std::uint32_t{8});
    put(file, std::uint32_t{4096U * 4096U * 20U});
    file += "abcdefgh";
    EXPECT_FALSE(parse_pcd(bytes_of(file), "a.pcd"));
}

RC_GTEST_PROP(Lzf, ReadsAnythingWithoutLeavingItsBuffers, (const std::vector<std::uint8_t>& in)) {
    std::vector<std::uint8_t> out(64);
    static_cast<void>(decompress_lzf(in, out));  // the sanitizer watches
}

RC_GTEST_PROP(Pcd, SurvivesAnyChangedByte, ()) {
    for (const std::string& whole : {ascii(), binary(), compressed()}) {
        std::string file = whole;
        const auto at = *rc::gen::inRange<std::size_t>(0, file.size());
        file[at] = static_cast<char>(*rc::gen::inRange(0, 256));
        static_cast<void>(parse_pcd(bytes_of(file), "a.pcd"));
    }
}

TEST(Lzf, RepeatsWhatItWroteBefore) {
    // "ab", then a copy of 6 from 2 back.
    const std::vector<std::uint8_t> packed = {1, 'a', 'b', (4U << 5U), 1};
    std::vector<std::uint8_t> out(8);
    ASSERT_TRUE(decompress_lzf(packed, out));
    EXPECT_EQ(std::string(out.begin(), out.end()), "abababab");
    std::vector<std::uint8_t> too_small(7);
    EXPECT_FALSE(decompress_lzf(packed, too_small));
}

TEST(PcdSequence, ReadsAFolderInTheOrderOfItsNumbers) {
    const test::ScratchFolder scratch;
    for (const int k : {10, 9, 1}) {
        std::string file =
            "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 16\nHEIGHT 16\n"
            "POINTS 256\nDATA binary\n";
        for (int v = 0; v < 16; ++v) {
            for (int u = 0; u < 16; ++u) {
                const float z = 0.5F + 0.1F * static_cast<float>(k);
                put(file, z * (static_cast<float>(u) - 7.5F) / 20.0F);
                put(file, z * (static_cast<float>(v) - 7.5F) / 20.0F);
                put(file, z);
            }
        }
        test::write_text(scratch / ("frame_" + std::to_string(k) + ".pcd"), file);
    }
    test::write_text(
        scratch / "camera.json", R"({"fx":20,"fy":20,"cx":7.5,"cy":7.5,"depth_scale":1000})"
    );
    auto source = open_recording(scratch.path());
    ASSERT_TRUE(source) << to_text(source.error());
    RgbdFrame frame;
    TimeNs last = -1;
    for (const int k : {1, 9, 10}) {
        const auto status = (*source)->next(frame, 1s);
        ASSERT_TRUE(status) << to_text(status.error());
        const double metres = frame.depth[100] * (*source)->info().camera.depth_unit_m;
        EXPECT_NEAR(metres, 0.5 + 0.1 * k, 1e-4);
        EXPECT_GT(frame.t, last);
        last = frame.t;
    }
    EXPECT_EQ((*source)->next(frame, 1s), FrameStatus::end);
}

TEST(PcdSequence, RefusesACloudOfAnotherCamera) {
    const test::ScratchFolder scratch;
    std::string file =
        "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 640\nHEIGHT 480\n"
        "POINTS 307200\nDATA binary\n";
    for (int v = 0; v < 480; ++v) {
        for (int u = 0; u < 640; ++u) {
            put(file, (static_cast<float>(u) - 319.5F) / 365.0F);
            put(file, (static_cast<float>(v) - 239.5F) / 365.0F);
            put(file, 1.0F);
        }
    }
    test::write_text(scratch / "a.pcd", file);
    auto source = open_recording(scratch / "a.pcd");
    ASSERT_TRUE(source);
    RgbdFrame frame;
    const auto status = (*source)->next(frame, 1s);
    ASSERT_FALSE(status);
    EXPECT_THAT(status.error().cure, HasSubstr("camera.json"));
}

/// A wall across the axis of a camera of f = 20 px, in metres times `unit`.
std::string wall(int side, float z, float unit = 1.0F) {
    std::string file = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
                       std::to_string(side) + "\nHEIGHT " + std::to_string(side) + "\nPOINTS " +
                       std::to_string(side * side) + "\nDATA binary\n";
    const float middle = 0.5F * static_cast<float>(side - 1);
    for (int v = 0; v < side; ++v)
        for (int u = 0; u < side; ++u) {
            put(file, unit * z * (static_cast<float>(u) - middle) / 20.0F);
            put(file, unit * z * (static_cast<float>(v) - middle) / 20.0F);
            put(file, unit * z);
        }
    return file;
}

/// What reading a folder to its end gives: an error's text, or how many readings each frame has.
std::string outcome_of(const std::filesystem::path& path) {
    auto source = open_recording(path);
    if (!source) return to_text(source.error());
    std::string readings;
    RgbdFrame frame;
    while (true) {
        const auto status = (*source)->next(frame, 1s);
        if (!status) return to_text(status.error());
        if (*status == FrameStatus::end) return readings;
        const auto holes = std::count(frame.depth.begin(), frame.depth.end(), 0);
        readings += std::to_string(static_cast<long>(frame.depth.size()) - holes) + " ";
    }
}

constexpr const char* kLens = R"({"fx":20,"fy":20,"cx":7.5,"cy":7.5})";

TEST(PcdSequence, NeedsNoDepthScale) {
    const test::ScratchFolder scratch;
    test::write_text(scratch / "camera.json", kLens);
    test::write_text(scratch / "1.pcd", wall(16, 1.0F));
    EXPECT_EQ(outcome_of(scratch.path()), "256 ");
}

TEST(PcdSequence, ACloudWithoutReadingsIsAFrameWithoutReadings) {
    const test::ScratchFolder scratch;
    test::write_text(scratch / "camera.json", kLens);
    test::write_text(scratch / "1.pcd", wall(16, 1.0F));
    test::write_text(scratch / "2.pcd", wall(16, std::nanf("")));
    EXPECT_EQ(outcome_of(scratch.path()), "256 0 ");
}

TEST(PcdSequence, BadCloudsAreNamedWithTheirCure) {
    struct Case {
        std::string second;
        const char* message;
        const char* cure;
    };
    std::string empty = wall(16, 1.0F);
    empty.replace(empty.find("WIDTH 16"), 8, "WIDTH 0");
    for (const Case& c :
         {Case{empty, "is empty: its header says 0x16 points", "leave the file out"},
          Case{wall(20, 1.0F), "is 20x20, but the first, 1.pcd, is 16x16", "all of one size"},
          Case{wall(16, 1.0F, 1000.0F), "the nearest is at z = 1000", "divide by 1000"}}) {
        const test::ScratchFolder scratch;
        test::write_text(scratch / "camera.json", kLens);
        test::write_text(scratch / "1.pcd", wall(16, 1.0F));
        test::write_text(scratch / "2.pcd", c.second);
        const std::string outcome = outcome_of(scratch.path());
        EXPECT_THAT(outcome, HasSubstr("2.pcd"));
        EXPECT_THAT(outcome, HasSubstr(c.message));
        EXPECT_THAT(outcome, HasSubstr(c.cure));
    }
}

TEST(PcdSequence, EndingsMayBeInCapitals) {
    const test::ScratchFolder scratch;
    test::write_text(scratch / "camera.json", kLens);
    test::write_text(scratch / "1.PCD", wall(16, 1.0F));
    EXPECT_EQ(outcome_of(scratch.path()), "256 ");
    EXPECT_EQ(outcome_of(scratch / "1.PCD"), "256 ");
}

}  // namespace
}  // namespace kinectlab
