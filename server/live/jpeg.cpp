#include "server/live/jpeg.hpp"

#include <stdexcept>

#include <turbojpeg.h>

namespace kinectlab::live {
namespace {

constexpr int kQuality = 80;

struct Destroy {
    void operator()(void* handle) const { tjDestroy(handle); }
};

void append_le(std::string& out, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i)
        out.push_back(static_cast<char>((value >> (8 * i)) & 0xFFU));
}

}  // namespace

std::string encode_jpeg(const bus::PictureTaken& picture) {
    const auto pixels = static_cast<std::size_t>(picture.width) * picture.height;
    if (!picture.rgb || picture.rgb->size() != 3 * pixels) {
        throw std::invalid_argument("a picture whose size does not fit its pixels");
    }
    const std::unique_ptr<void, Destroy> codec(tjInitCompress());
    if (!codec) throw std::runtime_error("the JPEG codec cannot be opened");
    std::string jpeg(tjBufSize(picture.width, picture.height, TJSAMP_420), '\0');
    auto* out = reinterpret_cast<unsigned char*>(jpeg.data());
    unsigned long size = jpeg.size();
    const int failed = tjCompress2(
        codec.get(),
        picture.rgb->data(),
        picture.width,
        0,
        picture.height,
        TJPF_RGB,
        &out,
        &size,
        TJSAMP_420,
        kQuality,
        TJFLAG_NOREALLOC | TJFLAG_FASTDCT
    );
    if (failed != 0) throw std::runtime_error(tjGetErrorStr2(codec.get()));
    jpeg.resize(size);
    return jpeg;
}

std::shared_ptr<const std::string> JpegCache::packet(const bus::PictureTaken& picture) {
    const std::lock_guard lock(mutex_);
    Entry& entry = newest_[picture.rig];
    if (entry.packet && entry.t == picture.t) return entry.packet;
    const std::string jpeg = encode_jpeg(picture);
    std::string packet;
    packet.reserve(kHeaderBytes + jpeg.size());
    append_le(packet, 1, 4);
    append_le(packet, jpeg.size(), 4);
    append_le(packet, static_cast<std::uint64_t>(picture.t), 8);
    packet += jpeg;
    entry = {picture.t, std::make_shared<const std::string>(std::move(packet))};
    return entry.packet;
}

}  // namespace kinectlab::live
