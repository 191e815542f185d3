// Depth images of a real camera, and an organised cloud of a Kinect, through the format.

#include "real_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cloud/eye.hpp"
#include "frames.hpp"
#include "png.hpp"

namespace roverd::cloud {
namespace {

TEST(CloudRealData, DepthImagesBecomeThePointsThatAreExpected) {
  ROVERD_REAL_DATA(expected_path, "sensors/clouds/depth-expected.json");
  const auto expected = nlohmann::json::parse(std::ifstream(expected_path));
  Params every_pixel;
  every_pixel.decimate = 1;
  Eye eye{every_pixel};
  for (const auto& [name, want] : expected.items()) {
    const Image image = png_of(expected_path.parent_path() / name);
    ASSERT_EQ(image.pixels.size(), 640U * 480U) << name;
    const Blob data = bytes_of(image.pixels);
    Decoder decoder(kMaxPoints);
    base::Sight sight;
    Eye::Seen seen;
    decoder.feed(
        encode(header_of(1), Depth{640, 480, 525.0F, 525.0F, 319.5F, 239.5F, 0.001F, data}),
        [&](const Frame& f) { seen = eye.look(f, sight); });
    ASSERT_EQ(sight.points.size(), 640U * 480U);
    EXPECT_EQ(seen.directions - seen.missing, want["valid"].get<std::uint64_t>());
    double sum_m = 0.0;
    float least_m = 1e9F;
    float most_m = 0.0F;
    for (const auto& p : sight.points) {
      if (p.echo != base::Echo::Hit) continue;
      sum_m += p.x_m;
      least_m = std::min(least_m, p.x_m);
      most_m = std::max(most_m, p.x_m);
    }
    EXPECT_NEAR(sum_m, want["sum"].get<double>() / 1000.0, 0.5);
    EXPECT_NEAR(least_m, want["min"].get<double>() / 1000.0, 1e-6);
    EXPECT_NEAR(most_m, want["max"].get<double>() / 1000.0, 1e-6);
    for (const auto& pixel : want["pixels"]) {
      const auto& p =
          sight.points[pixel["v"].get<std::size_t>() * 640 + pixel["u"].get<std::size_t>()];
      EXPECT_NEAR(p.x_m, pixel["z_ahead"].get<double>(), 1e-4);
      EXPECT_NEAR(p.y_m, -pixel["x_right"].get<double>(), 1e-4);
      EXPECT_NEAR(p.z_m, -pixel["y_down"].get<double>(), 1e-4);
    }
  }
}

/// LZF: a byte below 32 begins as many literals and one more, a greater one a repetition.
Blob unpacked(Bytes in, std::size_t size) {
  Blob out;
  out.reserve(size);
  for (std::size_t i = 0; i < in.size();) {
    const unsigned control = in[i++];
    if (control < 32) {
      for (unsigned n = 0; n <= control; ++n) out.push_back(in[i++]);
      continue;
    }
    std::size_t length = control >> 5U;
    if (length == 7) length += in[i++];
    std::size_t from = out.size() - ((control & 0x1FU) << 8U) - in[i++] - 1;
    for (std::size_t n = 0; n < length + 2; ++n) out.push_back(out[from++]);
  }
  return out;
}

TEST(CloudRealData, AnOrganisedCloudKeepsItsFinitePoints) {
  ROVERD_REAL_DATA(path, "sensors/clouds/table-organised-640x480.pcd");
  const auto file = tests::read_file(path);
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  constexpr std::string_view kData = "DATA binary_compressed\n";
  const auto at = text.find(kData) + kData.size();
  std::uint32_t packed = 0;
  std::uint32_t size = 0;
  std::memcpy(&packed, file.data() + at, 4);
  std::memcpy(&size, file.data() + at + 4, 4);
  const Blob columns = unpacked(Bytes(file).subspan(at + 8, packed), size);
  ASSERT_EQ(columns.size(), size);
  constexpr std::size_t kCount = 640 * 480;
  std::vector<float> xyz;  // column by column in the file, optical axes
  for (std::size_t i = 0; i < kCount; ++i) {
    for (const std::size_t axis : {1U, 2U, 3U}) {  // after the labels
      xyz.push_back(f32_at(columns.data() + 4 * (axis * kCount + i)));
    }
  }
  Header h = header_of(1);
  h.optical = true;
  Eye eye{Params{}};
  Decoder decoder(kMaxPoints);
  base::Sight sight;
  Eye::Seen seen;
  decoder.feed(cloud_frame(h, xyz), [&](const Frame& f) { seen = eye.look(f, sight); });
  EXPECT_EQ(seen.directions, kCount);
  EXPECT_EQ(sight.points.size(), 182'292U);
  for (const auto& p : sight.points) {
    ASSERT_GT(p.x_m, 0.3F) << "the table lies ahead";
    ASSERT_EQ(p.echo, base::Echo::Hit);
  }
}

}  // namespace
}  // namespace roverd::cloud
