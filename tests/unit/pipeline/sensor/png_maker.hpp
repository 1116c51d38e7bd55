#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <libdeflate.h>

namespace kinectlab::test {

using Bytes = std::vector<std::uint8_t>;

inline void append_big_endian(Bytes& bytes, std::uint32_t number) {
    for (const unsigned shift : {24U, 16U, 8U, 0U})
        bytes.push_back(static_cast<std::uint8_t>(number >> shift));
}

/// A chunk of a PNG with its length and checksum.
inline Bytes png_chunk(const std::string& kind, const Bytes& data) {
    Bytes checked(kind.begin(), kind.end());
    checked.insert(checked.end(), data.begin(), data.end());
    Bytes chunk;
    append_big_endian(chunk, static_cast<std::uint32_t>(data.size()));
    chunk.insert(chunk.end(), checked.begin(), checked.end());
    append_big_endian(chunk, libdeflate_crc32(0, checked.data(), checked.size()));
    return chunk;
}

/// An IHDR of a depth picture, unless told otherwise.
struct PngHeader {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint8_t bits = 16;
    std::uint8_t colours = 0;
    std::uint8_t interlaced = 0;
};

inline Bytes png_chunk(const PngHeader& header) {
    Bytes data;
    append_big_endian(data, header.width);
    append_big_endian(data, header.height);
    for (const std::uint8_t byte :
         {header.bits, header.colours, std::uint8_t{0}, std::uint8_t{0}, header.interlaced})
        data.push_back(byte);
    return png_chunk("IHDR", data);
}

inline Bytes png_file(const std::vector<Bytes>& chunks) {
    Bytes file{137, 80, 78, 71, 13, 10, 26, 10};
    for (const auto& chunk : chunks)
        file.insert(file.end(), chunk.begin(), chunk.end());
    return file;
}

/// As IDAT holds it.
inline Bytes zlib_packed(const Bytes& raw) {
    const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> packer(
        libdeflate_alloc_compressor(6), &libdeflate_free_compressor
    );
    if (!packer) throw std::bad_alloc();
    Bytes packed(libdeflate_zlib_compress_bound(packer.get(), raw.size()));
    packed.resize(
        libdeflate_zlib_compress(packer.get(), raw.data(), raw.size(), packed.data(), packed.size())
    );
    return packed;
}

/// The rows of a 16-bit grey picture, each behind its filter's number: the standard's, in turn.
inline Bytes filtered_rows(
    const std::vector<std::uint16_t>& depth, std::size_t width, const std::vector<int>& filters
) {
    Bytes plain;
    for (const std::uint16_t counts : depth)
        for (const unsigned shift : {8U, 0U})
            plain.push_back(static_cast<std::uint8_t>(counts >> shift));
    const std::size_t stride = 2 * width;
    Bytes rows;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        const std::size_t x = i % stride, y = i / stride;
        const int filter = filters[y % filters.size()];
        if (x == 0) rows.push_back(static_cast<std::uint8_t>(filter));
        const int a = x >= 2 ? plain[i - 2] : 0;
        const int b = y >= 1 ? plain[i - stride] : 0;
        const int c = x >= 2 && y >= 1 ? plain[i - stride - 2] : 0;
        const int pa = std::abs(b - c), pb = std::abs(a - c), pc = std::abs(a + b - 2 * c);
        const int paeth = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
        const int predictions[] = {0, a, b, (a + b) / 2, paeth};
        rows.push_back(static_cast<std::uint8_t>(plain[i] - predictions[filter]));
    }
    return rows;
}

/// The depth picture whose rows are given, filtered.
inline Bytes png_of_rows(const PngHeader& header, const Bytes& rows) {
    return png_file(
        {png_chunk(header), png_chunk("IDAT", zlib_packed(rows)), png_chunk("IEND", Bytes{})}
    );
}

}  // namespace kinectlab::test
