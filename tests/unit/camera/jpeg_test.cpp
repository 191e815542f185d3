#include "camera/jpeg.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

#include "camera/params.hpp"
#include "pictures.hpp"

namespace roverd::camera {
namespace {

Bytes as_bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// 64x48, brighter to the right.
std::vector<std::uint8_t> ramp() {
  std::vector<std::uint8_t> out;
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 64; ++u) out.push_back(static_cast<std::uint8_t>(4 * u));
  }
  return out;
}

TEST(CameraJpeg, GreyGoesThroughNearlyUnchanged) {
  const auto pixels = ramp();
  const auto jpeg = jpeg_of_grey(pixels, 64, 48, 64, 92).value();
  const auto shape = shape_of(jpeg).value();
  EXPECT_EQ(shape.width, 64);
  EXPECT_EQ(shape.height, 48);
  EXPECT_EQ(shape.size, jpeg.size());
  const auto grey = grey_of(jpeg).value();
  ASSERT_EQ(grey.bytes.size(), pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    ASSERT_LE(std::abs(int{grey.bytes[i]} - int{pixels[i]}), 3) << i;
  }
}

TEST(CameraJpeg, RowsThatAreFilledUpAreReadAsTheyAre) {
  std::vector<std::uint8_t> padded;
  const auto pixels = ramp();
  for (std::size_t v = 0; v < 48; ++v) {
    const auto row = pixels.begin() + static_cast<std::ptrdiff_t>(64 * v);
    padded.insert(padded.end(), row, row + 64);
    padded.insert(padded.end(), 8, 255);
  }
  padded.resize(padded.size() - 8);  // nothing follows the last row
  EXPECT_EQ(jpeg_of_grey(padded, 64, 48, 72, 92).value(),
            jpeg_of_grey(pixels, 64, 48, 64, 92).value());
  padded.pop_back();
  EXPECT_FALSE(jpeg_of_grey(padded, 64, 48, 72, 92));
}

TEST(CameraJpeg, TheBrightnessOfYuyvIsItsEvenBytes) {
  std::vector<std::uint8_t> yuyv;
  for (const std::uint8_t y : ramp()) {
    yuyv.push_back(y);
    yuyv.push_back(128);
  }
  const auto grey = grey_of(jpeg_of_yuyv(yuyv, 64, 48, 128, 92).value()).value();
  const auto pixels = ramp();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    ASSERT_LE(std::abs(int{grey.bytes[i]} - int{pixels[i]}), 4) << i;
  }
  EXPECT_FALSE(jpeg_of_yuyv(yuyv, 63, 48, 128, 92));
}

TEST(CameraJpeg, WhatFillsUpABufferIsNoPartOfIt) {
  const std::string jpeg = picture(50);
  const auto shape = shape_of(as_bytes(jpeg + std::string(100, '\0'))).value();
  EXPECT_EQ(shape.size, jpeg.size());
}

TEST(CameraJpeg, EachCutOfAPictureIsRefusedInWords) {
  const std::string jpeg = picture(50);
  for (std::size_t n = 0; n < jpeg.size(); ++n) {
    ASSERT_FALSE(shape_of(as_bytes(jpeg.substr(0, n)))) << n;
    ASSERT_FALSE(grey_of(as_bytes(jpeg.substr(0, n)))) << n;
  }
  const auto why = [](const std::string& text) { return shape_of(as_bytes(text)).error().detail; };
  EXPECT_EQ(why("GIF89a"), "picture that is no JPEG");
  EXPECT_EQ(why(jpeg.substr(0, jpeg.size() - 2)), "picture that does not end");
  std::string large = jpeg;
  const auto frame = large.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  large[frame + 5] = 0x20;  // 8192 + 16 rows
  EXPECT_EQ(why(large), "picture is larger than 4096 pixels: 16x8208");
  std::string lossless = jpeg;
  lossless[frame + 1] = '\xC3';
  EXPECT_EQ(why(lossless), "picture of a kind that browsers do not show");
}

TEST(CameraJpeg, PixelsThatAreDamagedAreNoGreyImage) {
  const auto jpeg = jpeg_of_grey(ramp(), 64, 48, 64, 92).value();
  const auto shape = shape_of(jpeg).value();
  std::vector<std::uint8_t> torn(jpeg.begin(),
                                 jpeg.begin() + static_cast<std::ptrdiff_t>(shape.scan + 20));
  torn.insert(torn.end(), {0xFF, 0xD9});
  ASSERT_TRUE(shape_of(torn)) << "its markers are all there";
  EXPECT_EQ(grey_of(torn).error().code, base::Code::Malformed);
}

TEST(CameraJpeg, ASmallerOneShowsTheSame) {
  const auto jpeg = jpeg_of_grey(ramp(), 64, 48, 64, 92).value();
  const auto small = grey_of(smaller(jpeg, 4, 80).value()).value();
  EXPECT_EQ(small.width, 16);
  EXPECT_EQ(small.height, 12);
  EXPECT_NEAR(small.bytes[8], 4 * 33.5, 8);
}

TEST(CameraLens, ItIsThatOfThePicturesSize) {
  Params p;
  EXPECT_FALSE(lens_of(p, 640, 480)) << "nothing was told";
  p.fov_deg = 90.0;
  const auto whole = lens_of(p, 640, 480).value();
  EXPECT_NEAR(whole.fx, 320.0, 1e-9);
  EXPECT_NEAR(whole.cy, 240.0, 1e-9);
  const auto half = lens_of(p, 320, 240).value();
  EXPECT_NEAR(half.fx, 160.0, 1e-9);
  EXPECT_NEAR(half.cx, 160.0, 1e-9);
  EXPECT_FALSE(lens_of(p, 640, 360)) << "cut, nobody knows where";
  p.fx = 500.0;
  EXPECT_EQ(validate(p).error().fields.at(0).pointer, "fov_deg");
  p.fov_deg = 0.0;
  p.cx = 300.0;
  EXPECT_TRUE(validate(p));
  EXPECT_NEAR(lens_of(p, 1280, 960).value().cx, 600.0, 1e-9);
}

}  // namespace
}  // namespace roverd::camera
