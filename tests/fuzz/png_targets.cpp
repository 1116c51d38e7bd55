#include "tests/fuzz/png_targets.hpp"

#include <optional>
#include <stdexcept>

#include "pipeline/sensor/png_image.hpp"
#include "tests/unit/pipeline/sensor/png_maker.hpp"

namespace kinectlab::fuzz {
namespace {

using test::png_chunk;

constexpr std::uint32_t kWidth = 21, kHeight = 11;
using Depth = std::vector<std::uint16_t>;

std::optional<Depth> decoded(const Bytes& file) {
    Depth depth(kWidth * kHeight);
    if (!decode_png(file, std::span<std::uint16_t>(depth), "input")) return std::nullopt;
    return depth;
}

}  // namespace

Bytes png_rows() {
    Depth depth(kWidth * kHeight);
    for (std::size_t i = 0; i < depth.size(); ++i)
        depth[i] = static_cast<std::uint16_t>(1000 + 7 * i);
    return test::filtered_rows(depth, kWidth, {1, 4, 3, 2, 0});
}

Bytes png_data() {
    return test::zlib_packed(png_rows());
}

bool read_png_rows(const Bytes& rows) {
    Bytes all = rows;
    all.resize(kHeight * (1 + 2 * kWidth));  // else nearly no input would come to the filters
    return read_png_data(test::zlib_packed(all));
}

bool read_png_data(const Bytes& data) {
    const Bytes header = png_chunk(test::PngHeader{kWidth, kHeight});
    const Bytes pixels = png_chunk("IDAT", data);
    const Bytes end = png_chunk("IEND", Bytes{});
    const Bytes gamma = png_chunk("gAMA", {0, 0, 0xb1, 0x8f});
    const auto depth = decoded(test::png_file({header, pixels, end}));
    if (depth != decoded(test::png_file({header, gamma, pixels, end})))
        throw std::logic_error("libspng reads another picture");
    return depth.has_value();
}

}  // namespace kinectlab::fuzz
