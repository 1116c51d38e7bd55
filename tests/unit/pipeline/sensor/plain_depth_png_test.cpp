#include "pipeline/sensor/plain_depth_png.hpp"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/sensor/png_image.hpp"
#include "tests/unit/pipeline/sensor/png_maker.hpp"

namespace kinectlab {
namespace {

using test::Bytes;
using test::filtered_rows;
using test::png_chunk;
using test::png_file;
using test::png_of_rows;
using test::PngHeader;
using test::zlib_packed;

using Depth = std::vector<std::uint16_t>;

constexpr std::uint32_t kWidth = 21;  // two blocks of eight columns and some more
constexpr std::uint32_t kHeight = 11;
constexpr PngHeader kHeader{kWidth, kHeight};

// A surface with noise: neighbours alike, as the filters expect them, and others not.
Depth some_depth() {
    std::mt19937 random(7);
    Depth depth;
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i)
        depth.push_back(static_cast<std::uint16_t>(i % 5 == 0 ? random() : 1020 + random() % 12));
    return depth;
}

std::optional<Depth> plainly_read(const Bytes& file) {
    Depth depth(kWidth * kHeight);
    if (!read_plain_depth_png(file, depth)) return std::nullopt;
    return depth;
}

std::optional<Depth> decoded(const Bytes& file) {
    Depth depth(kWidth * kHeight);
    if (!decode_png(file, std::span<std::uint16_t>(depth), "a.png")) return std::nullopt;
    return depth;
}

TEST(PlainDepthPng, ReadsEveryFilter) {
    const Depth depth = some_depth();
    for (const auto& filters :
         std::vector<std::vector<int>>{{0}, {1}, {2}, {3}, {4}, {4, 3, 2, 1, 0}, {2, 2, 4, 1, 3}}) {
        const auto rows = filtered_rows(depth, kWidth, filters);
        EXPECT_EQ(plainly_read(png_of_rows(kHeader, rows)), depth)
            << testing::PrintToString(filters);
    }
}

TEST(PlainDepthPng, ReadsWhatTheProjectWrites) {
    const Depth depth = some_depth();
    const auto file =
        encode_png(std::span<const std::uint16_t>(depth), {int{kWidth}, int{kHeight}});
    EXPECT_EQ(plainly_read(file), depth);
}

TEST(PlainDepthPng, ReadsDataInManyChunks) {
    const Depth depth = some_depth();
    const Bytes packed = zlib_packed(filtered_rows(depth, kWidth, {1}));
    std::vector<Bytes> chunks{png_chunk(kHeader)};
    for (std::size_t i = 0; i < packed.size(); i += 100)
        chunks.push_back(png_chunk(
            "IDAT",
            Bytes(
                packed.begin() + static_cast<long>(i),
                packed.begin() + static_cast<long>(std::min(packed.size(), i + 100))
            )
        ));
    chunks.push_back(png_chunk("IEND", {}));
    EXPECT_EQ(plainly_read(png_file(chunks)), depth);
}

// What is sound but unusual gives the same pixels through libspng.
TEST(PlainDepthPng, LeavesOtherChunksToLibspng) {
    const Depth depth = some_depth();
    const Bytes data = png_chunk("IDAT", zlib_packed(filtered_rows(depth, kWidth, {4, 1, 3})));
    const Bytes gamma = png_chunk("gAMA", {0, 0, 0xb1, 0x8f});
    const Bytes file = png_file({png_chunk(kHeader), gamma, data, png_chunk("IEND", {})});
    EXPECT_EQ(plainly_read(file), std::nullopt);
    EXPECT_EQ(decoded(file), depth);
}

struct Fault {
    const char* name;
    std::function<Bytes()> file;
};

void PrintTo(const Fault& fault, std::ostream* out) {
    *out << fault.name;
}

class PlainDepthPngFault : public testing::TestWithParam<Fault> {};

TEST_P(PlainDepthPngFault, IsLeftToLibspng) {
    EXPECT_EQ(plainly_read(GetParam().file()), std::nullopt);
}

Bytes sound_rows() {
    return filtered_rows(some_depth(), kWidth, {1});
}

Bytes with_header(PngHeader header) {
    return png_of_rows(header, sound_rows());
}

Bytes with_data(const Bytes& packed) {
    return png_file({png_chunk(kHeader), png_chunk("IDAT", packed), png_chunk("IEND", {})});
}

/// The sound file with one byte changed, counted from the end if negative.
Bytes changed(long place) {
    Bytes file = with_header(kHeader);
    file.at(static_cast<std::size_t>(place < 0 ? static_cast<long>(file.size()) + place : place)) ^=
        1U;
    return file;
}

INSTANTIATE_TEST_SUITE_P(
    All,
    PlainDepthPngFault,
    testing::Values(
        Fault{
            "nothing",
            [] {
                return Bytes{};
            }},
        Fault{
            "signature",
            [] {
                return changed(1);
            }},
        Fault{
            "signature_alone",
            [] {
                return png_file({});
            }},
        Fault{
            "eight_bits",
            [] {
                return with_header({kWidth, kHeight, 8});
            }},
        Fault{
            "colour",
            [] {
                return with_header({kWidth, kHeight, 16, 2});
            }},
        Fault{
            "interlaced",
            [] {
                return with_header({kWidth, kHeight, 16, 0, 1});
            }},
        Fault{
            "no_width",
            [] {
                return with_header({0, kHeight});
            }},
        Fault{
            "higher",
            [] {
                return with_header({kWidth, kHeight + 1});
            }},
        Fault{
            "enormous",
            [] {
                return with_header({0xffffffffU, 0xffffffffU});
            }},
        Fault{
            "header_checksum",
            [] {
                return changed(8 + 8 + 13);
            }},
        Fault{
            "data_checksum",
            [] {
                return changed(-13);
            }},
        Fault{
            "end_checksum",
            [] {
                return changed(-1);
            }},
        Fault{
            "chunk_length",
            [] {
                return changed(8 + 25);
            }},
        Fault{
            "no_end",
            [] {
                Bytes file = with_header(kHeader);
                file.erase(file.end() - 12, file.end());
                return file;
            }},
        Fault{
            "no_data",
            [] {
                return png_file({png_chunk(kHeader), png_chunk("IEND", {})});
            }},
        Fault{
            "no_zlib",
            [] {
                return with_data(Bytes(50, 7));
            }},
        Fault{
            "data_end_too_early",
            [] {
                Bytes packed = zlib_packed(sound_rows());
                packed.resize(packed.size() / 2);
                return with_data(packed);
            }},
        Fault{
            "data_go_on",
            [] {
                Bytes packed = zlib_packed(sound_rows());
                packed.push_back(0);
                return with_data(packed);
            }},
        Fault{
            "checksum_of_rows",
            [] {
                Bytes packed = zlib_packed(sound_rows());
                packed.back() ^= 1U;
                return with_data(packed);
            }},
        Fault{
            "too_few_rows",
            [] {
                Bytes rows = sound_rows();
                rows.pop_back();
                return png_of_rows(kHeader, rows);
            }},
        Fault{
            "too_many_rows",
            [] {
                Bytes rows = sound_rows();
                rows.push_back(0);
                return png_of_rows(kHeader, rows);
            }},
        Fault{
            "no_such_filter",
            [] {
                Bytes rows = sound_rows();
                rows.at(2 * (1 + 2 * kWidth)) = 5;
                return png_of_rows(kHeader, rows);
            }}
    ),
    [](const auto& info) { return std::string(info.param.name); }
);

TEST(PlainDepthPng, RefusesASideThatIsTooLong) {
    constexpr std::uint32_t kLong = kMaxPictureSide + 1;
    Depth depth(kLong);
    const auto file = png_of_rows({kLong, 1}, filtered_rows(depth, kLong, {0}));
    EXPECT_FALSE(read_plain_depth_png(file, depth));
}

}  // namespace
}  // namespace kinectlab
