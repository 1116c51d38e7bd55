#include "pipeline/sensor/png_image.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>

#include <libdeflate.h>
#include <spng.h>

#include "pipeline/sensor/plain_depth_png.hpp"

namespace kinectlab {
namespace {

struct FreeContext {
    void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
using Context = std::unique_ptr<spng_ctx, FreeContext>;

constexpr std::size_t kMaxChunk =
    256 * 1024;  // of metadata; pictures stand in IDAT, which has no such limit

tl::unexpected<Error> damaged(const std::string& name, int code) {
    return fail(
        ErrorCode::bad_data,
        name,
        std::string("is no readable PNG: ") + spng_strerror(code),
        "give an undamaged PNG file"
    );
}

Result<Context> open(std::span<const std::uint8_t> file, const std::string& name) {
    Context context(spng_ctx_new(0));
    if (!context) throw std::bad_alloc();
    spng_set_image_limits(context.get(), kMaxPictureSide, kMaxPictureSide);
    spng_set_chunk_limits(context.get(), kMaxChunk, kMaxChunk);
    if (const int code = spng_set_png_buffer(context.get(), file.data(), file.size()))
        return damaged(name, code);
    return context;
}

Result<void> decode(
    std::span<const std::uint8_t> file,
    std::span<std::uint8_t> out,
    int format,
    const std::string& name
) {
    auto context = open(file, name);
    if (!context) return tl::unexpected<Error>(context.error());
    std::size_t size = 0;
    int code = spng_decoded_image_size(context->get(), format, &size);
    if (code == 0 && size != out.size()) {
        return fail(
            ErrorCode::bad_data,
            name,
            "has another size than its header said",
            "give a PNG file that is not being written"
        );
    }
    if (code == 0) code = spng_decode_image(context->get(), out.data(), out.size(), format, 0);
    if (code != 0) return damaged(name, code);
    return {};
}

std::vector<std::uint8_t> encode(std::span<const std::uint8_t> pixels, PngSize size, PngKind kind) {
    const Context context(spng_ctx_new(SPNG_CTX_ENCODER));
    if (!context) throw std::bad_alloc();
    spng_ihdr header{};
    header.width = static_cast<std::uint32_t>(size.width);
    header.height = static_cast<std::uint32_t>(size.height);
    header.bit_depth = kind == PngKind::depth16 ? 16 : 8;
    header.color_type =
        kind == PngKind::depth16 ? SPNG_COLOR_TYPE_GRAYSCALE : SPNG_COLOR_TYPE_TRUECOLOR;
    spng_set_ihdr(context.get(), &header);
    spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
    spng_set_option(context.get(), SPNG_IMG_COMPRESSION_LEVEL, 1);
    // One filter for all rows: trying each of them costs more time than it saves bytes.
    spng_set_option(context.get(), SPNG_FILTER_CHOICE, SPNG_FILTER_CHOICE_SUB);
    int code = spng_encode_image(
        context.get(), pixels.data(), pixels.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE
    );
    std::size_t length = 0;
    const std::unique_ptr<void, decltype(&std::free)> buffer(
        code == 0 ? spng_get_png_buffer(context.get(), &length, &code) : nullptr, &std::free
    );
    if (code != 0)
        throw std::runtime_error(std::string("cannot encode a PNG: ") + spng_strerror(code));
    const auto* bytes = static_cast<const std::uint8_t*>(buffer.get());
    return {bytes, bytes + length};
}

std::string describe(const spng_ihdr& header) {
    const char* colours = header.color_type == SPNG_COLOR_TYPE_GRAYSCALE         ? "grey"
                          : header.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA ? "grey with alpha"
                          : header.color_type == SPNG_COLOR_TYPE_INDEXED         ? "with a palette"
                          : header.color_type == SPNG_COLOR_TYPE_TRUECOLOR       ? "RGB"
                                                                                 : "RGBA";
    return std::to_string(header.bit_depth) + "-bit " + colours;
}

constexpr std::size_t kSignature = 8;

std::uint32_t big_endian(std::span<const std::uint8_t> bytes) {
    std::uint32_t value = 0;
    for (const std::uint8_t byte : bytes.first(4))
        value = value << 8U | byte;
    return value;
}

}  // namespace

Result<void> check_png(std::span<const std::uint8_t> file, const std::string& name) {
    const auto bad = [&](const char* message) {
        return fail(ErrorCode::bad_data, name, message, "give an undamaged PNG file");
    };
    constexpr std::array<std::uint8_t, kSignature> kBegin{137, 80, 78, 71, 13, 10, 26, 10};
    if (file.size() < kSignature || !std::equal(kBegin.begin(), kBegin.end(), file.begin()))
        return bad("is no PNG");
    auto rest = file.subspan(kSignature);
    while (rest.size() >= 12) {  // length, kind, data, checksum
        const std::size_t length = big_endian(rest);
        if (length > rest.size() - 12) break;
        const auto kind_and_data = rest.subspan(4, length + 4);
        const auto crc = libdeflate_crc32(0, kind_and_data.data(), kind_and_data.size());
        if (crc != big_endian(rest.subspan(length + 8)))
            return bad("is damaged: a checksum is wrong");
        if (std::memcmp(kind_and_data.data(), "IEND", 4) == 0) return {};
        rest = rest.subspan(length + 12);
    }
    return bad("is damaged: it ends too early");
}

Result<PngSize> read_png_size(
    std::span<const std::uint8_t> file, PngKind kind, const std::string& name
) {
    auto context = open(file, name);
    if (!context) return tl::unexpected<Error>(context.error());
    spng_ihdr header{};
    const int code = spng_get_ihdr(context->get(), &header);
    if (code == SPNG_EUSER_WIDTH || code == SPNG_EUSER_HEIGHT) {
        return fail(
            ErrorCode::bad_data, name, "is a PNG above 4096 x 4096", "give a smaller picture"
        );
    }
    if (code != 0) return damaged(name, code);
    const bool grey16 = header.color_type == SPNG_COLOR_TYPE_GRAYSCALE && header.bit_depth == 16;
    const bool rgb8 = (header.color_type == SPNG_COLOR_TYPE_TRUECOLOR ||
                       header.color_type == SPNG_COLOR_TYPE_TRUECOLOR_ALPHA) &&
                      header.bit_depth == 8;
    if (kind == PngKind::depth16 && !grey16) {
        return fail(
            ErrorCode::bad_data,
            name,
            "is a PNG of " + describe(header),
            "give depth as 16-bit grey"
        );
    }
    if (kind == PngKind::rgb8 && !rgb8) {
        return fail(
            ErrorCode::bad_data, name, "is a PNG of " + describe(header), "give colour as 8-bit RGB"
        );
    }
    return PngSize{static_cast<int>(header.width), static_cast<int>(header.height)};
}

Result<void> decode_png(
    std::span<const std::uint8_t> file, std::span<std::uint16_t> depth, const std::string& name
) {
    if (read_plain_depth_png(file, depth)) return {};
    const std::span<std::uint8_t> out(
        reinterpret_cast<std::uint8_t*>(depth.data()), depth.size_bytes()
    );
    return decode(file, out, SPNG_FMT_PNG, name);  // 16-bit in the machine's byte order
}

Result<void> decode_png(
    std::span<const std::uint8_t> file, std::span<std::uint8_t> rgb, const std::string& name
) {
    return decode(file, rgb, SPNG_FMT_RGB8, name);
}

std::vector<std::uint8_t> encode_png(std::span<const std::uint16_t> depth, PngSize size) {
    return encode(
        {reinterpret_cast<const std::uint8_t*>(depth.data()), depth.size_bytes()},
        size,
        PngKind::depth16
    );
}

std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> rgb, PngSize size) {
    return encode(rgb, size, PngKind::rgb8);
}

}  // namespace kinectlab
