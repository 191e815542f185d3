// 603 packets of a real VLP-16 with dual return, and the same turn as another driver decoded it.

#include "real_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "velodyne/revolutions.hpp"

namespace roverd::velodyne {
namespace {

using base::Echo;
using base::SightPoint;

constexpr const char* kPackets = "sensors/velodyne/vlp16-packets.bin";
constexpr const char* kStamps = "sensors/velodyne/vlp16-stamps.txt";
constexpr const char* kExpected = "sensors/velodyne/vlp16-expected.json";
constexpr const char* kCloud = "sensors/velodyne/vlp16-one-revolution.pcd";

std::vector<Packet> packets_of(const std::filesystem::path& path) {
  const auto bytes = tests::read_file(path);
  std::vector<Packet> out;
  for (std::size_t at = 0; at + kPacketSize <= bytes.size(); at += kPacketSize) {
    const Decoded d = decode(Bytes(bytes).subspan(at, kPacketSize));
    EXPECT_EQ(d.fault, Fault::None) << describe(d);
    out.push_back(d.packet);
  }
  return out;
}

std::vector<Time> stamps_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<Time> out;
  long long s = 0;
  char dot = 0;
  std::string ns;
  while (in >> s >> dot >> ns) {
    out.emplace_back(std::chrono::seconds(s) + std::chrono::nanoseconds(std::stoll(ns)));
  }
  return out;
}

/// All turns, parts of turns too.
std::vector<Turn> turns_of(const std::vector<Packet>& packets, const std::vector<Time>& stamps,
                           Revolutions::Counts& counts) {
  std::vector<Turn> out;
  Revolutions revolutions("front", {}, [&](const Turn& t) { out.push_back(t); });
  for (std::size_t i = 0; i < packets.size(); ++i) revolutions.add(packets[i], stamps[i]);
  revolutions.finish();
  counts = revolutions.counts();
  return out;
}

TEST(VelodyneRealData, CountsAndSumsOfTheWordsAreTheRecordings) {
  ROVERD_REAL_DATA(path, kPackets);
  ROVERD_REAL_DATA(expected_path, kExpected);
  const auto packets = packets_of(path);
  const auto expected = nlohmann::json::parse(std::ifstream(expected_path));
  ASSERT_EQ(packets.size(), expected["packets"].get<std::size_t>());
  std::uint64_t returns = 0;
  std::uint64_t words = 0;
  std::uint64_t reflectivity = 0;
  std::uint64_t equal = 0;
  std::uint64_t different = 0;
  std::uint64_t even_nearer = 0;
  for (const Packet& p : packets) {
    EXPECT_EQ(p.mode, ReturnMode::Dual);
    EXPECT_EQ(p.product, Product::Vlp16);
    for (std::size_t b = 0; b < kBlocks; ++b) {
      for (std::size_t c = 0; c < kChannels; ++c) {
        const Return r = p.blocks[b].channels[c];
        returns += r.distance != 0 ? 1U : 0U;
        words += r.distance;
        reflectivity += r.reflectivity;  // told without a return, too
        if (b % 2 == 1) continue;
        const Return odd = p.blocks[b + 1].channels[c];
        if (r.distance == 0 || odd.distance == 0) continue;
        ++(r.distance == odd.distance ? equal : different);
        even_nearer += r.distance < odd.distance ? 1U : 0U;
      }
    }
  }
  EXPECT_EQ(returns, expected["points_with_return"].get<std::uint64_t>());
  EXPECT_EQ(words, expected["sum_distance_words"].get<std::uint64_t>());
  EXPECT_EQ(reflectivity, expected["sum_reflectivity"].get<std::uint64_t>());
  EXPECT_EQ(packets.front().stamp_us, expected["first_timestamp_us"].get<std::uint32_t>());
  EXPECT_EQ(packets.back().stamp_us, expected["last_timestamp_us"].get<std::uint32_t>());
  EXPECT_EQ(equal, 57'413U);
  EXPECT_EQ(different, 708U);
  EXPECT_EQ(even_nearer, 0U) << "the even block holds the last return";
}

TEST(VelodyneRealData, TurnsAndEveryNamedPoint) {
  ROVERD_REAL_DATA(path, kPackets);
  ROVERD_REAL_DATA(stamps_path, kStamps);
  ROVERD_REAL_DATA(expected_path, kExpected);
  const auto packets = packets_of(path);
  const auto expected = nlohmann::json::parse(std::ifstream(expected_path));
  Revolutions::Counts counts;
  const auto turns = turns_of(packets, stamps_of(stamps_path), counts);
  EXPECT_EQ(counts.packets, 603U);
  EXPECT_EQ(counts.lost + counts.duplicates + counts.late + counts.jumps, 0U);
  // Four beginnings of a turn: with what lies before the first, five pieces, or one less.
  const auto whole = std::count_if(turns.begin(), turns.end(), [](auto& t) { return t.whole; });
  EXPECT_EQ(whole, 3);
  std::size_t hits = 0;
  for (const Turn& turn : turns) {
    if (turn.whole) {
      EXPECT_NEAR(60.0 / turn.duration_s, 602.8, 4.0);
    }
    for (const SightPoint& p : turn.sight->points) hits += p.echo == Echo::Hit ? 1U : 0U;
  }
  // Both returns once where they are equal; all lie within the limits of range.
  EXPECT_EQ(hits, 116'827U - 57'413U);
  // The packets of one point each, apart: the point is found where it should lie.
  for (const auto& want : expected["points"]) {
    if (want["range_m"].get<double>() == 0.0) continue;
    const Packet& packet = packets.at(want["packet"]);
    std::vector<SightPoint> points;
    Revolutions alone("one", {}, [&](const Turn& t) {
      points.insert(points.end(), t.sight->points.begin(), t.sight->points.end());
    });
    alone.add(packet, Time{std::chrono::hours(1)});
    alone.finish();
    const double range_m = want["range_m"];
    double nearest_m = 1e9;
    for (const SightPoint& p : points) {
      if (p.ring != ring_of(want["laser"].get<std::size_t>())) continue;
      nearest_m = std::min(nearest_m, std::hypot(p.x_m - want["robot_x"].get<double>(),
                                                 p.y_m - want["robot_y"].get<double>(),
                                                 p.z_m - want["Z_up"].get<double>()));
    }
    EXPECT_LT(nearest_m, 0.001 + 0.0002 * range_m) << want.dump();
  }
}

struct CloudPoint {
  float x, y, z;
  std::uint8_t intensity, return_type;
  std::uint16_t ring;
  float azimuth_rad, elevation_rad, distance_m;
  std::uint32_t stamp_ns;
};
static_assert(sizeof(CloudPoint) == 32);

std::vector<CloudPoint> cloud_of(const std::filesystem::path& path) {
  const auto bytes = tests::read_file(path);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  constexpr std::string_view kData = "DATA binary\n";
  const auto begin = text.find(kData) + kData.size();
  std::vector<CloudPoint> out((bytes.size() - begin) / sizeof(CloudPoint));
  std::memcpy(out.data(), bytes.data() + begin, out.size() * sizeof(CloudPoint));
  return out;
}

TEST(VelodyneRealData, EveryPointOfTheOtherDriverIsAmongOurs) {
  ROVERD_REAL_DATA(path, kPackets);
  ROVERD_REAL_DATA(stamps_path, kStamps);
  ROVERD_REAL_DATA(cloud_path, kCloud);
  Revolutions::Counts counts;
  const auto turns = turns_of(packets_of(path), stamps_of(stamps_path), counts);
  std::map<std::pair<unsigned, long>, std::vector<const SightPoint*>> ours;
  for (const Turn& turn : turns) {
    for (const SightPoint& p : turn.sight->points) {
      if (p.echo != Echo::Hit) continue;
      const auto word = std::lround(std::hypot(p.x_m, p.y_m, p.z_m) / kUnit_m);
      ours[{p.ring, word}].push_back(&p);
    }
  }
  const auto theirs = cloud_of(cloud_path);
  ASSERT_EQ(theirs.size(), 14'831U);
  std::vector<double> off_m;
  for (const CloudPoint& t : theirs) {
    double nearest_m = 1e9;
    for (const SightPoint* p : ours[{t.ring, std::lround(t.distance_m / kUnit_m)}]) {
      nearest_m = std::min<double>(nearest_m, std::hypot(p->x_m - t.x, p->y_m - t.y, p->z_m - t.z));
    }
    off_m.push_back(nearest_m);
  }
  std::sort(off_m.begin(), off_m.end());
  EXPECT_LT(off_m.back(), 0.05);
  EXPECT_LT(off_m[off_m.size() * 99 / 100], 0.03);
  EXPECT_LT(off_m[off_m.size() / 2], 0.0002);
  RecordProperty("median_um", static_cast<int>(off_m[off_m.size() / 2] * 1e6));
}

}  // namespace
}  // namespace roverd::velodyne
