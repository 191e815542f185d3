// roverd decode cloud and ranges.

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cloud/codec.hpp"
#include "tools/decode.hpp"

namespace roverd {
namespace {

using Json = nlohmann::ordered_json;
using Blob = std::vector<std::uint8_t>;

std::vector<Json> objects_of(Reader (*make)(OnObject), const Blob& bytes, std::size_t piece) {
  std::vector<Json> out;
  const Reader reader = make([&](const Json& object) { out.push_back(object); });
  for (base::Bytes rest(bytes); !rest.empty(); rest = rest.subspan(std::min(piece, rest.size()))) {
    reader.feed(rest.first(std::min(piece, rest.size())));
  }
  reader.finish();
  return out;
}

TEST(DecodeCloud, FramesOfAllKindsWithWhatIsWrongBetween) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  constexpr float kEndless = std::numeric_limits<float>::infinity();
  cloud::Header header;
  header.sequence = 7;
  header.stamp_ns = 1'500'000'000;
  header.pose = base::Mount{0.5, 0.0, 0.25, 0.0, 0.0, 0.0};
  const Blob xyz = cloud::bytes_of(std::vector<float>{1.0F, 2.0F, 3.0F, kNone, 0.0F, 0.0F});
  Blob file = cloud::encode(header, cloud::Cloud{2, 0.005F, xyz});
  file.insert(file.end(), {'x', 'y'});
  const Blob pixels = cloud::bytes_of(std::vector<std::uint16_t>{0, 955, 2702, 1000});
  header.good = false;
  header.pose.reset();
  const Blob image =
      cloud::encode(header, cloud::Depth{2, 2, 525.0F, 525.0F, 0.5F, 0.5F, 0.001F, pixels});
  file.insert(file.end(), image.begin(), image.end());
  const Blob ranges = cloud::bytes_of(std::vector<float>{1.5F, kEndless});
  const Blob fan = cloud::encode(header, cloud::Ranges{2, -0.5F, 0.25F, ranges});
  file.insert(file.end(), fan.begin(), fan.end());
  file.back() ^= 1U;  // its CRC is wrong now
  for (const std::size_t piece : {1U, 50U, 100'000U}) {
    const auto objects = objects_of(cloud_reader, file, piece);
    ASSERT_EQ(objects.size(), 4U);
    EXPECT_EQ(objects[0]["message"], "cloud");
    EXPECT_EQ(objects[0]["points"], 2);
    EXPECT_EQ(objects[0]["finite"], 1);
    EXPECT_EQ(objects[0]["sequence"], 7);
    EXPECT_EQ(objects[0]["stamp_ns"], 1'500'000'000);
    EXPECT_EQ(objects[0]["pose"]["x_m"], 0.5);
    EXPECT_EQ(objects[1]["refused"], "bytes outside any frame");
    EXPECT_EQ(objects[1]["count"], 2);
    EXPECT_EQ(objects[2]["message"], "depth");
    EXPECT_EQ(objects[2]["width"], 2);
    EXPECT_EQ(objects[2]["valid"], 3);
    EXPECT_EQ(objects[2]["least"], 955);
    EXPECT_EQ(objects[2]["most"], 2702);
    EXPECT_EQ(objects[2]["good"], false);
    EXPECT_FALSE(objects[2].contains("pose"));
    EXPECT_EQ(objects[3]["refused"], "a body with a wrong CRC");
  }
  file.back() ^= 1U;
  const Json whole = objects_of(cloud_reader, file, 9).back();
  EXPECT_EQ(whole["message"], "ranges");
  EXPECT_EQ(whole["range_m"].dump(), "[1.5,null]");
}

TEST(DecodeRanges, LinesWithTheirReadings) {
  const std::string text = "R 1.200 - 85 cm\r\nnonsense here\n0.5";
  const auto objects = objects_of(ranges_reader, Blob(text.begin(), text.end()), 4);
  ASSERT_EQ(objects.size(), 3U);
  EXPECT_EQ(objects[0]["line"], "R 1.200 - 85 cm");
  EXPECT_EQ(objects[0]["range_m"].dump(), "[1.2,\"nothing\",0.85]");
  EXPECT_TRUE(objects[1].contains("refused"));
  EXPECT_EQ(objects[2]["range_m"].dump(), "[0.5]");
}

}  // namespace
}  // namespace roverd
