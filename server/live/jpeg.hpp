#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "server/bus/events.hpp"

namespace kinectlab::live {

/// The colour picture as JPEG, quality 80, 4:2:0. Throws if the codec fails.
[[nodiscard]] std::string encode_jpeg(const bus::PictureTaken& picture);

/// Encodes each picture once, whoever asks for it. Thread-safe.
class JpegCache {
public:
    /// As on the wire: u32 1, u32 length of the JPEG, u64 capture time in ns, the JPEG;
    /// little-endian.
    [[nodiscard]] std::shared_ptr<const std::string> packet(const bus::PictureTaken& picture);

    static constexpr std::size_t kHeaderBytes = 16;

private:
    struct Entry {
        TimeNs t = 0;
        std::shared_ptr<const std::string> packet;
    };
    std::mutex mutex_;
    std::map<std::string, Entry> newest_;  ///< by rig
};

}  // namespace kinectlab::live
