// roverd decode vlp16: bare packets, captures, and what is neither.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pcap/pcap.hpp"
#include "real_data.hpp"
#include "tools/decode.hpp"
#include "velodyne/codec.hpp"

namespace roverd {
namespace {

using Json = nlohmann::ordered_json;
using Blob = std::vector<std::uint8_t>;

std::vector<Json> vlp16_objects(const Blob& bytes, std::size_t piece) {
  std::vector<Json> out;
  const Reader reader = vlp16_reader([&](const Json& object) { out.push_back(object); });
  for (base::Bytes rest(bytes); !rest.empty(); rest = rest.subspan(std::min(piece, rest.size()))) {
    reader.feed(rest.first(std::min(piece, rest.size())));
  }
  reader.finish();
  return out;
}

Blob one_packet() {
  velodyne::Packet p;
  p.stamp_us = 1'234'567;
  p.blocks[3].azimuth_cdeg = 4620;
  p.blocks[3].channels[17] = {2501, 99};
  const auto bytes = velodyne::encode(p);
  return {bytes.begin(), bytes.end()};
}
Blob one_position() {
  velodyne::Position p;
  p.stamp_us = 77;
  p.pps = 2;
  p.nmea = "$GPRMC,,V,,,,,,,,,,N*53";
  const auto bytes = velodyne::encode(p);
  return {bytes.begin(), bytes.end()};
}
void append(Blob& to, const Blob& what) {
  to.insert(to.end(), what.begin(), what.end());
}

void expect_data(const Json& object) {
  EXPECT_EQ(object["message"], "data");
  EXPECT_EQ(object["timestamp_us"], 1'234'567);
  EXPECT_EQ(object["return_mode"], "strongest");
  EXPECT_EQ(object["return_mode_hex"], "37");
  EXPECT_EQ(object["product"], "VLP-16");
  EXPECT_EQ(object["product_hex"], "22");
  ASSERT_EQ(object["blocks"].size(), 12U);
  const Json& block = object["blocks"][3];
  EXPECT_EQ(block["azimuth_deg"].dump(), "46.2");
  EXPECT_EQ(block["range_m"][17].dump(), "5.002");
  EXPECT_TRUE(block["range_m"][16].is_null());
  EXPECT_EQ(block["reflectivity"][17], 99);
}

TEST(DecodeVlp16, BarePacketsOneAfterAnotherWithRubbishBetween) {
  Blob file = one_packet();
  append(file, Blob(700, 0x11));
  append(file, one_position());
  append(file, one_packet());
  for (const std::size_t piece : {1U, 333U, 100'000U}) {
    const auto objects = vlp16_objects(file, piece);
    ASSERT_EQ(objects.size(), 4U);
    expect_data(objects[0]);
    EXPECT_EQ(objects[1]["skipped_bytes"], 700);
    EXPECT_EQ(objects[2]["message"], "position");
    EXPECT_EQ(objects[2]["pps"], 2);
    EXPECT_EQ(objects[2]["nmea"], "$GPRMC,,V,,,,,,,,,,N*53");
    expect_data(objects[3]);
    EXPECT_EQ(objects[3]["packet"], 2);
  }
}

TEST(DecodeVlp16, ACaptureTellsWhenAndFromWhom) {
  const auto header = pcap::file_header();
  Blob file(header.begin(), header.end());
  const pcap::Address sensor{{192, 168, 1, 201}, 2368};
  const pcap::Address all{{255, 255, 255, 255}, 2368};
  const base::WallTime stamp{std::chrono::seconds(1'673'400'471)};
  append(file, pcap::record({stamp, sensor, all, one_packet()}));
  append(file, pcap::record({stamp, sensor, all, Blob(100, 1)}));
  const auto objects = vlp16_objects(file, 1000);
  ASSERT_EQ(objects.size(), 2U);
  expect_data(objects[0]);
  EXPECT_EQ(objects[0]["time"], "2023-01-11T01:27:51.000Z");
  EXPECT_EQ(objects[0]["from"], "192.168.1.201:2368");
  EXPECT_EQ(objects[0]["to_port"], 2368);
  EXPECT_EQ(objects[1]["refused"], "neither 1206 bytes (data) nor 512 (position)");
  file.resize(file.size() - 1);
  EXPECT_EQ(vlp16_objects(file, 1000).back()["capture"], "broken");
}

TEST(DecodeVlp16, OtherSensorsAndCutFilesAreRefusedInWords) {
  Blob other = one_packet();
  other[1205] = 0x28;
  EXPECT_EQ(vlp16_objects(other, 5000).at(0)["refused"],
            "product 28 is a VLP-32C: only VLP-16 (22) and VLP-16 Hi-Res (24) are understood");
  Blob cut = one_packet();
  cut.pop_back();
  EXPECT_EQ(vlp16_objects(cut, 5000).at(0)["skipped_bytes"], 1205);
  EXPECT_TRUE(vlp16_objects({}, 1).empty());
}

TEST(DecodeVlp16, WhatIsNoPacketIsSkippedAndNothingIsInvented) {
  // A receiver's log is full of these sentences, and none of them is a position packet.
  Blob log;
  const std::string line = "$GPRMC,120000.00,A,5822.5,N,02642.3,E,0.0,0.0,010126,,,A*5C\r\n";
  for (int i = 0; i < 60; ++i) append(log, Blob(line.begin(), line.end()));
  Blob dollars(4000, '$');
  Blob zeros(206, 0);
  append(zeros, Blob(800, '$'));
  for (const Blob& file : {log, dollars, zeros}) {
    for (const std::size_t piece : {1U, 777U}) {
      std::size_t skipped = 0;
      for (const Json& object : vlp16_objects(file, piece)) {
        ASSERT_TRUE(object.contains("skipped_bytes")) << object.dump();
        skipped += object["skipped_bytes"].get<std::size_t>();
      }
      EXPECT_EQ(skipped, file.size());
    }
  }
}

TEST(DecodeVlp16, TheRealPacketsAreAllThere) {
  ROVERD_REAL_DATA(path, "sensors/velodyne/vlp16-packets.bin");
  const auto objects = vlp16_objects(tests::read_file(path), 65'536);
  ASSERT_EQ(objects.size(), 603U);
  for (const Json& object : objects) {
    EXPECT_FALSE(object.contains("refused"));
    EXPECT_EQ(object["return_mode_hex"], "39");
  }
  EXPECT_EQ(objects.front()["timestamp_us"], 140'554'572);
  EXPECT_EQ(objects.back()["timestamp_us"], 140'954'030);
}

}  // namespace
}  // namespace roverd
