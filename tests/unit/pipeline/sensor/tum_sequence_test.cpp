#include "pipeline/sensor/tum_sequence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/sensor/png_image.hpp"
#include "pipeline/sensor/recording.hpp"
#include "pipeline/sensor/sequence_writer.hpp"
#include "tests/unit/pipeline/sensor/scratch_folder.hpp"

namespace kinectlab {
namespace {

using namespace std::chrono_literals;
using test::read_text;
using test::ScratchFolder;
using test::write_text;
using testing::HasSubstr;

constexpr int kWidth = 64;
constexpr int kHeight = 48;

SourceInfo small_source() {
    SourceInfo info;
    info.camera.depth = {kWidth, kHeight, 58.0, 58.0, 31.5, 23.5};
    info.camera.colour = {kWidth, kHeight, 52.0, 52.0, 31.0, 24.0};
    info.camera.T_colour_depth.translation() = Eigen::Vector3d(-0.025, 0, 0);
    info.camera.noise = {2.5e-3, 0.6};
    info.camera.clock_u = 3e-5;
    info.T_lab_cam = Eigen::Isometry3d(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()));
    info.T_lab_cam->translation() = Eigen::Vector3d(4, 2, 3);
    return info;
}

RgbdFrame frame_number(std::uint64_t k) {
    RgbdFrame frame;
    frame.index = k;
    frame.t = 1'700'000'000'123'456'789 + static_cast<TimeNs>(k) * 33'333'333;
    frame.t_colour = frame.t + 5'000'000;
    for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
        frame.depth.push_back(static_cast<std::uint16_t>((i * 7919 + k) % 65536));
        for (std::size_t c = 0; c < 3; ++c)
            frame.rgb.push_back(static_cast<std::uint8_t>(i * 31 + c * 7 + k));
    }
    return frame;
}

void write_recording(const std::filesystem::path& folder, std::uint64_t frames = 5) {
    auto writer = SequenceWriter::create(folder, small_source());
    ASSERT_TRUE(writer) << to_text(writer.error());
    for (std::uint64_t k = 0; k < frames; ++k)
        ASSERT_TRUE(writer->add(frame_number(k)));
    writer->finish();
}

// The first error on the way to the end, whether opening or reading finds it.
std::optional<Error> error_of(const std::filesystem::path& path) {
    auto source = open_recording(path);
    if (!source) return source.error();
    RgbdFrame frame;
    while (true) {
        const auto status = (*source)->next(frame, 1s);
        if (!status) return status.error();
        if (*status == FrameStatus::end) return std::nullopt;
    }
}

void replace(const std::filesystem::path& file, const std::string& from, const std::string& to) {
    std::string text = read_text(file);
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from << " in " << text;
    write_text(file, text.replace(at, from.size(), to));
}

TEST(TumSequence, ComesBackAsItWasWritten) {
    const ScratchFolder scratch;
    write_recording(scratch / "r");
    auto source = open_recording(scratch / "r");
    ASSERT_TRUE(source) << to_text(source.error());
    const SourceInfo& info = (*source)->info();
    const SourceInfo wanted = small_source();
    EXPECT_EQ(info.name, "r");
    EXPECT_EQ(info.frame_count, 5u);
    EXPECT_EQ(info.camera.depth_unit_m, 0.001);
    EXPECT_EQ(info.camera.depth.fx, wanted.camera.depth.fx);
    EXPECT_EQ(info.camera.colour.cx, wanted.camera.colour.cx);
    EXPECT_EQ(info.camera.noise.sigma_steps, 0.6);
    EXPECT_EQ(info.camera.clock_u, 3e-5);
    EXPECT_TRUE(info.camera.T_colour_depth.isApprox(wanted.camera.T_colour_depth, 1e-12));
    ASSERT_TRUE(info.T_lab_cam);
    EXPECT_TRUE(info.T_lab_cam->isApprox(*wanted.T_lab_cam, 1e-12));
    EXPECT_NEAR(info.frame_rate_hz, 30.0, 1e-6);

    RgbdFrame frame;
    for (std::uint64_t k = 0; k < 5; ++k) {
        const auto status = (*source)->next(frame, 1s);
        ASSERT_TRUE(status) << to_text(status.error());
        ASSERT_EQ(*status, FrameStatus::frame);
        const RgbdFrame written = frame_number(k);
        EXPECT_EQ(frame.index, k);
        EXPECT_EQ(frame.t, written.t);
        EXPECT_EQ(frame.t_colour, written.t_colour);
        EXPECT_EQ(frame.depth, written.depth);
        EXPECT_EQ(frame.rgb, written.rgb);
    }
    EXPECT_EQ((*source)->next(frame, 1s), FrameStatus::end);
}

TEST(TumSequence, WithoutColourReadsDepthAlone) {
    const ScratchFolder scratch;
    write_recording(scratch / "r");
    auto source = open_recording(scratch / "r", {.with_colour = false});
    ASSERT_TRUE(source);
    RgbdFrame frame;
    ASSERT_TRUE((*source)->next(frame, 1s));
    EXPECT_TRUE(frame.rgb.empty());
    EXPECT_EQ(frame.depth, frame_number(0).depth);
}

TEST(TumSequence, DamagedColourIsFoundWithoutDecodingIt) {
    const ScratchFolder scratch;
    write_recording(scratch / "r");
    EXPECT_EQ(check_colour_pictures(scratch / "r").damaged, 0U);
    EXPECT_EQ(check_colour_pictures(scratch / "r").all, 5U);
    std::vector<std::filesystem::path> pictures;
    for (const auto& entry : std::filesystem::directory_iterator(scratch / "r/rgb"))
        pictures.push_back(entry.path());
    ASSERT_EQ(pictures.size(), 5U);
    std::string flipped = read_text(pictures[1]);
    flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 1);
    write_text(pictures[1], flipped);
    EXPECT_EQ(check_colour_pictures(scratch / "r").damaged, 1U);
    const std::string whole = read_text(pictures[3]);
    write_text(pictures[3], whole.substr(0, whole.size() - 20));
    const auto found = check_colour_pictures(scratch / "r");
    EXPECT_EQ(found.damaged, 2U);
    ASSERT_TRUE(found.first);
    EXPECT_THAT(found.first->field, testing::HasSubstr(".png"));
    EXPECT_THAT(found.first->message, testing::HasSubstr("damaged"));
}

struct Damage {
    const char* name;
    std::function<void(const std::filesystem::path&)> act;
    const char* field;    ///< part of it: the file, with the line where there is one
    const char* message;  ///< part of message and cure
};

void PrintTo(const Damage& damage, std::ostream* out) {
    *out << damage.name;
}

class DamagedRecording : public testing::TestWithParam<Damage> {};

TEST_P(DamagedRecording, IsAnErrorThatNamesTheFile) {
    const ScratchFolder scratch;
    const auto folder = scratch / "r";
    write_recording(folder);
    ASSERT_FALSE(error_of(folder));
    GetParam().act(folder);
    const auto error = error_of(folder);
    ASSERT_TRUE(error);
    EXPECT_THAT(error->field, HasSubstr(GetParam().field));
    EXPECT_THAT(error->message + "; " + error->cure, HasSubstr(GetParam().message));
    EXPECT_FALSE(error->cure.empty());
}

std::filesystem::path picture(const std::filesystem::path& folder, const char* kind, int k) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder / kind))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files.at(static_cast<std::size_t>(k));
}

template <class Pixel>
void put_picture(const std::filesystem::path& file, int width, int height, int channels) {
    const std::vector<Pixel> pixels(static_cast<std::size_t>(width * height * channels), 1);
    const auto bytes = encode_png(std::span<const Pixel>(pixels), {width, height});
    write_text(file, std::string(bytes.begin(), bytes.end()));
}

// The second line of a list becomes `line`.
void put_line(const std::filesystem::path& list, const std::string& line) {
    const std::string text = read_text(list);
    const auto start = text.find('\n') + 1;
    const auto end = text.find('\n', start);
    write_text(list, text.substr(0, start) + line + text.substr(end));
}

using Path = const std::filesystem::path&;

INSTANTIATE_TEST_SUITE_P(
    All,
    DamagedRecording,
    testing::Values(
        Damage{"no depth list", [](Path p) { remove(p / "depth.txt"); }, "depth.txt", "not there"},
        Damage{"no colour list", [](Path p) { remove(p / "rgb.txt"); }, "rgb.txt", "not there"},
        Damage{
            "empty list",
            [](Path p) { write_text(p / "depth.txt", "# a\n\n"); },
            "depth.txt",
            "no pictures"},
        Damage{
            "missing picture",
            [](Path p) { remove(picture(p, "depth", 3)); },
            "depth.txt:5",
            "not there"},
        Damage{
            "no path",
            [](Path p) { put_line(p / "depth.txt", "1700000000.1"); },
            "depth.txt:2",
            "timestamp path"},
        Damage{
            "no number",
            [](Path p) { put_line(p / "depth.txt", "today depth/1.png"); },
            "depth.txt:2",
            "timestamp path"},
        Damage{
            "negative time",
            [](Path p) { put_line(p / "depth.txt", "-1.0 depth/1.png"); },
            "depth.txt:2",
            "timestamp path"},
        Damage{
            "time runs backwards",
            [](Path p) {
                put_line(
                    p / "depth.txt",
                    "1800000000.0 depth/" + picture(p, "depth", 0).filename().string()
                );
            },
            "depth.txt:3",
            "increase"},
        Damage{
            "time repeats",
            [](Path p) {
                put_line(
                    p / "depth.txt",
                    "1700000000.156790122 depth/" + picture(p, "depth", 0).filename().string()
                );
            },
            "depth.txt:3",
            "increase"},
        Damage{
            "path leads out",
            [](Path p) { put_line(p / "depth.txt", "1700000000.1 depth/../../r/camera.json"); },
            "depth.txt:2",
            "leads out"},
        Damage{
            "absolute path",
            [](Path p) { put_line(p / "depth.txt", "1700000000.1 /etc/passwd"); },
            "depth.txt:2",
            "leads out"},
        Damage{
            "link leads out",
            [](Path p) {
                std::filesystem::create_symlink("/etc/passwd", p / "depth" / "x.png");
                put_line(p / "depth.txt", "1700000000.1 depth/x.png");
            },
            "depth.txt:2",
            "leads out"},
        Damage{
            "first picture of another size",
            [](Path p) { put_picture<std::uint16_t>(picture(p, "depth", 0), 32, 24, 1); },
            ".png",
            "64x48"},
        Damage{
            "later picture of another size",
            [](Path p) { put_picture<std::uint16_t>(picture(p, "depth", 2), 32, 24, 1); },
            ".png",
            "64x48"},
        Damage{
            "colour of another size",
            [](Path p) { put_picture<std::uint8_t>(picture(p, "rgb", 2), 32, 24, 3); },
            ".png",
            "64x48"},
        Damage{
            "colour where depth should be",
            [](Path p) { put_picture<std::uint8_t>(picture(p, "depth", 1), kWidth, kHeight, 3); },
            ".png",
            "16-bit grey"},
        Damage{
            "depth where colour should be",
            [](Path p) { put_picture<std::uint16_t>(picture(p, "rgb", 1), kWidth, kHeight, 1); },
            ".png",
            "8-bit RGB"},
        Damage{
            "truncated picture",
            [](Path p) {
                const auto file = picture(p, "depth", 1);
                write_text(file, read_text(file).substr(0, 200));
            },
            ".png",
            "readable PNG"},
        Damage{
            "no PNG",
            [](Path p) { write_text(picture(p, "depth", 1), "hello"); },
            ".png",
            "readable PNG"},
        Damage{
            "enormous picture",
            [](Path p) {
                const auto file = picture(p, "depth", 1);
                std::string png = read_text(file);
                png[16] = png[20] = '\x7f';  // width and height in IHDR
                write_text(file, png);
            },
            ".png",
            ""},
        Damage{
            "misspelt key",
            [](Path p) { replace(p / "camera.json", "\"fx\"", "\"fX\""); },
            "camera.json: color.fX",
            "did you mean fx"},
        Damage{
            "negative focal length",
            [](Path p) { replace(p / "camera.json", "58.0", "-58.0"); },
            "camera.json: ",
            "-58"},
        Damage{
            "no number as focal length",
            [](Path p) { replace(p / "camera.json", "58.0", "\"58\""); },
            "camera.json: ",
            "a number"},
        Damage{
            "infinite focal length",
            [](Path p) { replace(p / "camera.json", "58.0", "1e999"); },
            "camera.json",
            "JSON"},
        Damage{
            "missing focal length",
            [](Path p) { write_text(p / "camera.json", R"({"fx":58,"cx":31.5,"cy":23.5})"); },
            "camera.json: fy",
            "missing"},
        Damage{
            "no rotation",
            [](Path p) { replace(p / "camera.json", "1.0", "0.5"); },
            "camera.json: T_lab_cam",
            "rotate"},
        Damage{"no JSON", [](Path p) { write_text(p / "camera.json", "{"); }, "camera.json", "JSON"}
    ),
    [](const auto& info) {
        std::string name = info.param.name;
        std::replace(name.begin(), name.end(), ' ', '_');
        return name;
    }
);

TEST(TumSequence, WithoutCameraJsonIsTheDefaultCamera) {
    const ScratchFolder scratch;
    write_recording(scratch / "r", 1);
    remove(scratch / "r" / "camera.json");
    const auto wrong_size = error_of(scratch / "r");
    ASSERT_TRUE(wrong_size);
    EXPECT_THAT(wrong_size->message + wrong_size->cure, HasSubstr("640x480"));

    put_picture<std::uint16_t>(picture(scratch / "r", "depth", 0), 640, 480, 1);
    put_picture<std::uint8_t>(picture(scratch / "r", "rgb", 0), 640, 480, 3);
    auto source = open_recording(scratch / "r");
    ASSERT_TRUE(source) << to_text(source.error());
    EXPECT_EQ((*source)->info().camera.depth.fx, 525.0);
    EXPECT_EQ((*source)->info().camera.depth.cx, 319.5);
    EXPECT_EQ((*source)->info().camera.depth_unit_m, 1.0 / 5000);
}

TEST(TumSequence, PicturesThatDoNotFitTheCentreAreRefused) {
    const ScratchFolder scratch;
    write_recording(scratch / "r", 1);
    write_text(
        scratch / "r" / "camera.json",
        R"({"fx":525,"fy":525,"cx":319.5,"cy":239.5,"depth_scale":5000})"
    );
    const auto error = error_of(scratch / "r");
    ASSERT_TRUE(error);
    EXPECT_THAT(error->message, HasSubstr("64x48"));
}

TEST(TumSequence, PairsColourByTimeAndNotByOrder) {
    const std::vector<TumEntry> depth = {{100, "", 1}, {200, "", 2}, {300, "", 3}, {400, "", 4}};
    const std::vector<TumEntry> colour = {{30, "", 1}, {190, "", 2}, {260, "", 3}};
    const auto pairs = pair_by_time(depth, colour);
    ASSERT_EQ(pairs.size(), 4u);
    EXPECT_EQ(pairs[0], 0u);  // 70 away, within one step; 190 is 90 away
    EXPECT_EQ(pairs[1], 1u);
    EXPECT_EQ(pairs[2], 2u);
    EXPECT_EQ(pairs[3], std::nullopt);  // 140 away: no picture belongs to it
}

TEST(Timestamp, IsExactToTheNanosecond) {
    EXPECT_EQ(parse_timestamp("1305031102.175304"), 1305031102175304000);
    EXPECT_EQ(parse_timestamp("0"), 0);
    EXPECT_EQ(parse_timestamp("1."), 1'000'000'000);
    for (const char* wrong :
         {"", ".", ".5", "-1", "+1", "1e3", "nan", "1.2.3", "99999999999", "1,5"})
        EXPECT_FALSE(parse_timestamp(wrong)) << wrong;
    for (const TimeNs t : {TimeNs{0}, TimeNs{1}, TimeNs{1'700'000'000'123'456'789}})
        EXPECT_EQ(parse_timestamp(format_timestamp(t)), t);
}

TEST(SequenceWriter, LeavesNothingWithoutFinish) {
    const ScratchFolder scratch;
    {
        auto writer = SequenceWriter::create(scratch / "r", small_source());
        ASSERT_TRUE(writer);
        ASSERT_TRUE(writer->add(frame_number(0)));
        EXPECT_FALSE(std::filesystem::exists(scratch / "r"));
    }
    EXPECT_TRUE(std::filesystem::is_empty(scratch.path()));
}

TEST(SequenceWriter, RefusesAFolderWithSomethingInIt) {
    const ScratchFolder scratch;
    std::filesystem::create_directory(scratch / "r");
    write_text(scratch / "r" / "note.txt", "mine");
    const auto writer = SequenceWriter::create(scratch / "r", small_source());
    ASSERT_FALSE(writer);
    EXPECT_EQ(writer.error().code, ErrorCode::conflict);
    EXPECT_EQ(read_text(scratch / "r" / "note.txt"), "mine");
}

TEST(SequenceWriter, RefusesTimesThatDoNotIncrease) {
    const ScratchFolder scratch;
    auto writer = SequenceWriter::create(scratch / "r", small_source());
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->add(frame_number(1)));
    EXPECT_FALSE(writer->add(frame_number(1)));
    EXPECT_FALSE(writer->add(frame_number(0)));
}

TEST(SequenceWriter, KeepsTheTruthBesideTheFrames) {
    const ScratchFolder scratch;
    auto writer = SequenceWriter::create(scratch / "r", small_source());
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->add(frame_number(0)));
    writer->add_truth({frame_number(0).t, {0.1, -0.25, 1.5}, Eigen::Quaterniond::Identity()});
    writer->finish();
    const auto truth = read_groundtruth(scratch / "r");
    ASSERT_TRUE(truth) << to_text(truth.error());
    ASSERT_EQ(truth->size(), 1u);
    EXPECT_EQ(truth->front().t, frame_number(0).t);
    EXPECT_EQ(truth->front().p, Eigen::Vector3d(0.1, -0.25, 1.5));
}

}  // namespace
}  // namespace kinectlab
