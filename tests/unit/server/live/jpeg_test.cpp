#include "server/live/jpeg.hpp"

#include <gtest/gtest.h>

namespace kinectlab::live {
namespace {

bus::PictureTaken picture_at(TimeNs t) {
    bus::PictureTaken picture;
    picture.rig = "rig-1";
    picture.t = t;
    picture.width = 64;
    picture.height = 48;
    picture.rgb = std::make_shared<const std::vector<std::uint8_t>>(64 * 48 * 3, std::uint8_t{90});
    return picture;
}

TEST(JpegCache, PacksOnePictureOnce) {
    JpegCache cache;
    const auto packet = cache.packet(picture_at(0x0102030405060708));
    ASSERT_GT(packet->size(), JpegCache::kHeaderBytes + 4);
    EXPECT_EQ(packet->substr(0, 4), std::string("\1\0\0\0", 4));
    const auto* bytes = reinterpret_cast<const unsigned char*>(packet->data());
    EXPECT_EQ(bytes[4] + 256U * bytes[5], packet->size() - JpegCache::kHeaderBytes);
    EXPECT_EQ(packet->substr(8, 8), "\x08\x07\x06\x05\x04\x03\x02\x01");
    EXPECT_EQ(packet->substr(16, 2), "\xff\xd8");
    EXPECT_EQ(cache.packet(picture_at(0x0102030405060708)), packet);
    EXPECT_NE(cache.packet(picture_at(2)), packet);
}

TEST(EncodeJpeg, RefusesASizeThatDoesNotFit) {
    auto picture = picture_at(1);
    picture.height = 49;
    EXPECT_THROW(static_cast<void>(encode_jpeg(picture)), std::invalid_argument);
}

}  // namespace
}  // namespace kinectlab::live
