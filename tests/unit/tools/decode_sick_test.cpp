// roverd decode sick: bytes and sessions to lines of JSON.

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "real_data.hpp"
#include "sick/commands.hpp"
#include "sick/scan.hpp"
#include "tools/decode.hpp"

namespace roverd {
namespace {

using Json = nlohmann::ordered_json;

std::vector<Json> decoded(const std::vector<std::uint8_t>& bytes, std::size_t piece = 1000) {
  std::vector<Json> out;
  const Reader reader = sick_reader([&out](const Json& o) { out.push_back(o); });
  const base::Bytes all(bytes);
  for (std::size_t at = 0; at < all.size(); at += piece) {
    reader.feed(all.subspan(at, std::min(piece, all.size() - at)));
  }
  reader.finish();
  return out;
}
std::vector<std::uint8_t> raw(const std::string& text) {
  return {text.begin(), text.end()};
}

const std::string kScan =
    "sSN LMDscandata 1 1 1234 0 0 1 1 1 2 0 0 0 0 0 9C4 168 1 FFFFFFFB A 2 DIST1 40000000 "
    "00000000 FFFF3CB0 9C4 4 7D0 7D1 7D2 7D3 RSSI1 3F800000 00000000 FFFF3CB0 9C4 4 78 0 FF FFFF "
    "0 0 1 A Front left 0 1 7EA 5 14 B 3B 2A 3D090 0";

TEST(DecodeSick, NamesTheFieldsOfAScan) {
  for (const std::size_t piece : {std::size_t{1}, std::size_t{1000}}) {
    const auto objects = decoded(raw("\x02" + kScan + "\x03"), piece);
    ASSERT_EQ(objects.size(), 1u);
    const Json& o = objects[0];
    EXPECT_EQ(o["dialect"], "A");
    EXPECT_EQ(o["type"], "sSN");
    EXPECT_EQ(o["command"], "LMDscandata");
    EXPECT_EQ(o["serial_number"], 0x1234);
    EXPECT_EQ(o["status"], "ok");
    EXPECT_EQ(o["scan_frequency_hz"], 25.0);
    EXPECT_EQ(o["measurement_frequency_hz"], 36000.0);
    EXPECT_EQ(o["encoders"][0]["position"], -5);
    EXPECT_EQ(o["channels"][0]["name"], "DIST1");
    EXPECT_EQ(o["channels"][0]["scale"], 2.0);
    EXPECT_EQ(o["channels"][0]["start_angle_deg"], -5.0);
    EXPECT_EQ(o["channels"][0]["values"], Json({2000, 2001, 2002, 2003}));
    EXPECT_EQ(o["channels"][1]["values"], Json({120, 0, 255, 65535}));
    EXPECT_EQ(o["name"], "Front left");
    EXPECT_TRUE(o["position"].is_null());
    EXPECT_EQ(o["time_stamp"]["microsecond"], 250000);
  }
}

TEST(DecodeSick, NamesTheFieldsOfCommandsAndErrors) {
  const auto objects =
      decoded(raw("\x02sFA 3\x03\x02sRA LMPscancfg 9C4 1 9C4 FFF92230 225510\x03\x02"
                  "sAN mLMPsetscancfg 2 1388 1 1388 FFF92230 225510\x03\x02"
                  "sWN LMDscandatacfg 01 00 1 1 0 00 00 0 0 0 0 +1\x03\x02"
                  "sRA STlms 7 0 8 16:07:42\x03"));
  ASSERT_EQ(objects.size(), 5u);
  EXPECT_EQ(objects[0]["code"], 3);
  EXPECT_EQ(objects[0]["error"], "unknown variable index");
  EXPECT_EQ(objects[1]["scan_frequency_hz"], 25.0);
  EXPECT_EQ(objects[1]["resolution_deg"], 0.25);
  EXPECT_EQ(objects[1]["start_angle_deg"], -45.0);
  EXPECT_EQ(objects[1]["stop_angle_deg"], 225.0);
  EXPECT_EQ(objects[2]["error"], 2);
  EXPECT_EQ(objects[3]["remission"], true);
  EXPECT_EQ(objects[3]["every"], 1);
  EXPECT_EQ(objects[4]["state"], "ready for measurement");
  EXPECT_EQ(objects[4]["fields"], "7 0 8 16:07:42");
}

TEST(DecodeSick, SaysWhatIsRefusedAndWhy) {
  auto bytes = sick::login(sick::Dialect::B);
  bytes.back() ^= 1;
  const auto more = raw("\x02sSN LMDscandata 1 1 X\x03rubbish\x02sRN STl");
  bytes.insert(bytes.end(), more.begin(), more.end());
  const auto objects = decoded(bytes);
  ASSERT_EQ(objects.size(), 3u);
  EXPECT_EQ(objects[0]["skipped_bytes"], 32);
  EXPECT_EQ(objects[0]["refused"], "a telegram with a wrong checksum");
  EXPECT_EQ(objects[1]["refused"], "serial number: no such number");
  EXPECT_EQ(objects[2]["skipped_bytes"], 15);
}

TEST(DecodeSick, ReadsASessionAsText) {
  const auto objects =
      decoded(raw("0.5 > 0202020200000007734d4e2052756e19\r\n"
                  "0.625 < 02020202000000\n"
                  "0.75 < 0973414e2052756e200134\n"
                  "1 sFA 3\n"
                  "2 < 02zz\n"
                  "3 < 020\n"
                  "four sFA 3\n"));
  ASSERT_EQ(objects.size(), 6u);
  EXPECT_EQ(objects[0]["line"], 1);
  EXPECT_EQ(objects[0]["time"], 0.5);
  EXPECT_EQ(objects[0]["direction"], "to the scanner");
  EXPECT_EQ(objects[0]["command"], "Run");
  EXPECT_EQ(objects[1]["line"], 3);  // where the telegram ends
  EXPECT_EQ(objects[1]["type"], "sAN");
  EXPECT_EQ(objects[1]["fields"], "01");
  EXPECT_EQ(objects[2]["error"], "unknown variable index");
  EXPECT_EQ(objects[3]["refused"], "no hexadecimal digits");
  EXPECT_EQ(objects[4]["refused"], "half a byte at the end");
  EXPECT_EQ(objects[5]["refused"], "no time and telegram");
}

TEST(DecodeSick, RefusesALineWithoutEnd) {
  const auto objects = decoded(raw("1 < " + std::string(300'000, '0') + "\n2 sFA 3\n"));
  ASSERT_EQ(objects.size(), 2u);
  EXPECT_EQ(objects[0]["refused"], "the line is too long");
  EXPECT_EQ(objects[1]["code"], 3);
}

TEST(DecodeSick, RealSessionsOfBothDialectsSayTheSame) {
  ROVERD_REAL_DATA(path_b, "sensors/sick/lms111-cola-b-session.txt");
  ROVERD_REAL_DATA(path_a, "sensors/sick/lms111-cola-a-scans.txt");
  const auto of_b = decoded(tests::read_file(path_b));
  const auto of_a = decoded(tests::read_file(path_a));
  EXPECT_EQ(of_b.size(), 192u);
  ASSERT_EQ(of_a.size(), 90u);
  std::size_t i = 0;
  for (Json b : of_b) {
    EXPECT_FALSE(b.contains("refused")) << b.dump();
    if (b["type"] != "sSN" || b["command"] != "LMDscandata") continue;
    Json a = of_a.at(i++);
    for (const char* differs : {"line", "direction", "dialect"}) {
      a.erase(differs);
      b.erase(differs);
    }
    EXPECT_EQ(a, b);
  }
  EXPECT_EQ(i, 90u);
}

}  // namespace
}  // namespace roverd
