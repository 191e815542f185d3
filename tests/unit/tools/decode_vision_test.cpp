// roverd decode vision: lines, captures, and what is neither.

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "pcap/pcap.hpp"
#include "tools/decode.hpp"

namespace roverd {
namespace {

using Json = nlohmann::ordered_json;
using Blob = std::vector<std::uint8_t>;

std::vector<Json> vision_objects(const Blob& bytes, std::size_t piece) {
  std::vector<Json> out;
  const Reader reader = vision_reader([&](const Json& object) { out.push_back(object); });
  for (base::Bytes rest(bytes); !rest.empty(); rest = rest.subspan(std::min(piece, rest.size()))) {
    reader.feed(rest.first(std::min(piece, rest.size())));
  }
  reader.finish();
  return out;
}
Blob blob(std::string_view text) {
  return {text.begin(), text.end()};
}

TEST(DecodeVision, OneDatagramALine) {
  const Blob file = blob("cone#box: 1: 0.5 0.1 2: 1 0 2: 0.9 0 2 -1 0 0: 5200\r\n\nhello\n:::::");
  for (const std::size_t piece : {1U, 7U, 1000U}) {
    const auto objects = vision_objects(file, piece);
    ASSERT_EQ(objects.size(), 3U);
    EXPECT_EQ(objects[0]["packet"], 0);
    EXPECT_EQ(objects[0]["names"], Json({"cone", "box"}));
    EXPECT_EQ(objects[0]["landmarks"],
              Json::parse(R"([{"name":"box","x_m":0.5,"y_m":0.1,"z_m":2.0}])"));
    EXPECT_EQ(objects[0]["obstacles"].size(), 1U);
    EXPECT_EQ(objects[0]["planes"][0]["normal"]["x_m"], -1.0);
    EXPECT_EQ(objects[0]["planes"][0]["size"], 5200.0);
    EXPECT_EQ(objects[1]["refused"], "not six fields between colons: field 0 (names), byte 5");
    EXPECT_EQ(objects[2]["landmarks"], Json::array());
  }
}

TEST(DecodeVision, NothingAtAll) {
  EXPECT_TRUE(vision_objects({}, 1).empty());
  EXPECT_EQ(vision_objects(blob("::"), 1).size(), 1U);
  EXPECT_EQ(vision_objects(Blob(70'000, 'x'), 4096).at(0)["refused"], "longer than any datagram");
}

}  // namespace
}  // namespace roverd
