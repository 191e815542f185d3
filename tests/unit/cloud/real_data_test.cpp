// Depth images of a real camera, and an organised cloud of a Kinect, through the format.

#include "real_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include "cloud/eye.hpp"
#include "frames.hpp"

namespace roverd::cloud {
namespace {

std::uint32_t big32(const std::uint8_t* at) {
  return static_cast<std::uint32_t>(at[0] << 24 | at[1] << 16 | at[2] << 8 | at[3]);
}

struct Image {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint16_t> pixels;
};

int paeth(int a, int b, int c) {
  const int p = a + b - c;
  const int pa = std::abs(p - a);
  const int pb = std::abs(p - b);
  const int pc = std::abs(p - c);
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

/// 16-bit grey PNG (ISO 15948), not interlaced.
Image png_of(const std::filesystem::path& path) {
  const auto file = tests::read_file(path);
  Image out;
  Blob packed;
  for (std::size_t at = 8; at + 12 <= file.size();) {
    const std::uint32_t size = big32(file.data() + at);
    const std::string type(file.begin() + static_cast<std::ptrdiff_t>(at + 4),
                           file.begin() + static_cast<std::ptrdiff_t>(at + 8));
    const std::uint8_t* data = file.data() + at + 8;
    if (type == "IHDR") {
      out.width = big32(data);
      out.height = big32(data + 4);
      EXPECT_EQ(data[8], 16);
      EXPECT_EQ(data[9], 0);
    }
    if (type == "IDAT") packed.insert(packed.end(), data, data + size);
    at += 12 + size;
  }
  const std::size_t stride = std::size_t{out.width} * 2;
  Blob raw((stride + 1) * out.height);
  uLongf raw_size = raw.size();
  EXPECT_EQ(::uncompress(raw.data(), &raw_size, packed.data(), packed.size()), Z_OK);
  Blob above(stride, 0);
  for (std::size_t v = 0; v < out.height; ++v) {
    std::uint8_t* row = raw.data() + v * (stride + 1) + 1;
    const int filter = raw[v * (stride + 1)];
    for (std::size_t i = 0; i < stride; ++i) {
      const int a = i >= 2 ? row[i - 2] : 0;
      const int b = above[i];
      const int c = i >= 2 ? above[i - 2] : 0;
      const int add = filter == 1   ? a
                      : filter == 2 ? b
                      : filter == 3 ? (a + b) / 2
                      : filter == 4 ? paeth(a, b, c)
                                    : 0;
      row[i] = static_cast<std::uint8_t>(row[i] + add);
    }
    above.assign(row, row + stride);
    for (std::size_t u = 0; u < out.width; ++u) {
      out.pixels.push_back(static_cast<std::uint16_t>(row[2 * u] << 8 | row[2 * u + 1]));
    }
  }
  return out;
}

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
