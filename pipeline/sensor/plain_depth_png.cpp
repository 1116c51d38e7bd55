#include "pipeline/sensor/plain_depth_png.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <string_view>
#include <vector>

#include <libdeflate.h>

#include "pipeline/sensor/png_filters.hpp"
#include "pipeline/sensor/png_image.hpp"

namespace kinectlab {
namespace {

using Bytes = std::span<const std::uint8_t>;

std::size_t big_endian(Bytes bytes) {
    return std::size_t{bytes[0]} << 24U | std::size_t{bytes[1]} << 16U |
           std::size_t{bytes[2]} << 8U | bytes[3];
}

/// Goes from chunk to chunk; one that is not whole, or whose checksum is wrong, has no kind.
class Chunks {
public:
    explicit Chunks(Bytes file) : rest_(file) {}

    void next() {
        kind = {};
        if (rest_.size() < kFrame) return;
        const std::size_t length = big_endian(rest_);
        if (length > rest_.size() - kFrame) return;
        const Bytes checked = rest_.subspan(4, length + 4);
        if (libdeflate_crc32(0, checked.data(), checked.size()) !=
            big_endian(rest_.subspan(length + 8)))
            return;
        kind = {reinterpret_cast<const char*>(checked.data()), 4};
        data = checked.subspan(4);
        rest_ = rest_.subspan(length + kFrame);
    }

    std::string_view kind;
    Bytes data;

private:
    static constexpr std::size_t kFrame = 12;  // length, kind, checksum
    Bytes rest_;
};

struct FreeInflater {
    void operator()(libdeflate_decompressor* inflater) const {
        libdeflate_free_decompressor(inflater);
    }
};

/// True if the packed bytes are exactly the raw ones, their checksum among them.
bool inflate(Bytes packed, std::span<std::uint8_t> raw) {
    const std::unique_ptr<libdeflate_decompressor, FreeInflater> inflater(
        libdeflate_alloc_decompressor()
    );
    if (!inflater) throw std::bad_alloc();
    std::size_t read = 0, written = 0;
    const auto result = libdeflate_zlib_decompress_ex(
        inflater.get(), packed.data(), packed.size(), raw.data(), raw.size(), &read, &written
    );
    return result == LIBDEFLATE_SUCCESS && read == packed.size() && written == raw.size();
}

/// The picture's width if the header is that of 16-bit grey, not interlaced, of so many pixels
/// and no side too long; else 0.
std::size_t width_of(const Chunks& header, std::size_t pixels) {
    constexpr std::array<std::uint8_t, 5> kGrey16{16, 0, 0, 0, 0};
    if (header.kind != "IHDR" || header.data.size() != 8 + kGrey16.size()) return 0;
    if (!std::equal(kGrey16.begin(), kGrey16.end(), header.data.begin() + 8)) return 0;
    const std::size_t width = big_endian(header.data);
    const std::size_t height = big_endian(header.data.subspan(4));
    const bool fits = std::max(width, height) <= kMaxPictureSide && width * height == pixels;
    return fits ? width : 0;
}

}  // namespace

bool read_plain_depth_png(Bytes file, std::span<std::uint16_t> depth) {
    constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
    if (file.size() < kSignature.size() ||
        !std::equal(
            kSignature.begin(), kSignature.end(), reinterpret_cast<const char*>(file.data())
        ))
        return false;
    Chunks chunks(file.subspan(kSignature.size()));
    chunks.next();
    const std::size_t width = width_of(chunks, depth.size());
    if (width == 0) return false;

    std::vector<std::uint8_t> packed;
    packed.reserve(file.size());
    for (chunks.next(); chunks.kind == "IDAT"; chunks.next())
        packed.insert(packed.end(), chunks.data.begin(), chunks.data.end());
    if (chunks.kind != "IEND" || !chunks.data.empty()) return false;

    const std::size_t stride = 1 + 2 * width;
    const std::size_t size = depth.size() / width * stride;
    const auto raw = std::make_unique_for_overwrite<std::uint8_t[]>(size);
    if (!inflate(packed, {raw.get(), size})) return false;
    const std::vector<std::uint16_t> nothing(width);
    const std::uint16_t* above = nothing.data();
    const std::uint8_t* row = raw.get();
    for (; !depth.empty(); depth = depth.subspan(width), row += stride) {
        if (!undo_png_filter(row[0], row + 1, above, depth.first(width))) return false;
        above = depth.data();
    }
    return true;
}

}  // namespace kinectlab
