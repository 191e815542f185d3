// Packets to turns: where each point lies and when it was seen; losses, repetitions, clocks.

#include "velodyne/revolutions.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "packets.hpp"

namespace roverd::velodyne {
namespace {

using namespace std::chrono_literals;
using base::Echo;
using base::SightPoint;

struct Heard {
  explicit Heard(const Params& params = {})
      : revolutions("front", params, [this](const Turn& t) { turns.push_back(t); }) {}
  std::vector<Turn> turns;
  Revolutions revolutions;
  const std::vector<SightPoint>& points() const { return turns.back().sight->points; }
};

constexpr Time kArrival{std::chrono::hours(5)};

/// A row of the fact sheet's tables. X right, Y ahead, Z up.
struct Row {
  std::size_t block, channel;
  double after_us, range_m;
  int reflectivity;
  double right_m, ahead_m, up_m;
};

void expect_rows(const Heard& heard, const std::vector<Row>& rows) {
  ASSERT_EQ(heard.points().size(), kBlocks * kChannels);
  for (const Row& row : rows) {
    const SightPoint& p = heard.points()[row.block * kChannels + row.channel];
    const double tolerance_m = 0.005 + 0.0002 * row.range_m;
    EXPECT_EQ(p.echo, Echo::Hit);
    EXPECT_NEAR(p.x_m, row.ahead_m, tolerance_m) << row.block << " " << row.channel;
    EXPECT_NEAR(p.y_m, -row.right_m, tolerance_m) << row.block << " " << row.channel;
    EXPECT_NEAR(p.z_m, row.up_m, tolerance_m) << row.block << " " << row.channel;
    EXPECT_NEAR(p.after_s, row.after_us * 1e-6, 1e-7);
    EXPECT_EQ(p.intensity, row.reflectivity);
    EXPECT_EQ(p.ring, ring_of(row.channel % kLasers));
  }
}

TEST(VelodyneTurns, VectorALiesWhereTheSheetSays) {
  Heard heard;
  heard.revolutions.add(vector_a(), kArrival);
  heard.revolutions.finish();
  ASSERT_EQ(heard.turns.size(), 1U);
  expect_rows(heard, {{0, 0, 0.0, 5.0, 10, 3.4151, 3.4151, -1.2941},
                      {0, 1, 2.304, 5.2, 12, 3.6769, 3.6759, 0.0908},
                      {0, 15, 34.56, 8.0, 40, 5.4760, 5.4522, 2.0706},
                      {0, 16, 55.296, 8.2, 42, 5.6202, 5.5811, -2.1223},
                      {5, 17, 610.56, 8.5, 49, 6.2366, 5.7735, 0.1483},
                      {6, 30, 751.104, 11.12, 76, 8.2256, 7.4804, -0.1941},
                      {11, 31, 1306.368, 11.42, 83, 8.4160, 7.1310, 2.9557}});
  const auto& sight = *heard.turns[0].sight;
  EXPECT_EQ(sight.sensor, "front");
  EXPECT_FALSE(heard.turns[0].whole);
  EXPECT_NEAR(base::seconds(kArrival - sight.stamp), 1327.104e-6, 1e-8);
  EXPECT_NEAR(sight.half_step_rad, 0.1 * M_PI / 180.0, 1e-6);
  // The same packet at the same azimuth, told with the lasers' own heights.
  Params params;
  params.vertical_offsets = true;
  Heard higher(params);
  higher.revolutions.add(vector_a(), kArrival);
  higher.revolutions.finish();
  EXPECT_NEAR(higher.points()[0].z_m - heard.points()[0].z_m, 0.0112, 1e-5);
}

TEST(VelodyneTurns, VectorBGoesThroughNorthAndNamesWhatDidNotComeBack) {
  Heard heard;
  heard.revolutions.add(vector_b(), kArrival);
  heard.revolutions.finish();
  ASSERT_EQ(heard.turns.size(), 2U) << "a turn ends where the azimuth falls back";
  EXPECT_EQ(heard.turns[0].sight->points.size(), 2 * kChannels);
  const auto& before = heard.turns[0].sight->points;
  EXPECT_EQ(before[0].echo, Echo::Unknown);
  EXPECT_NEAR(std::hypot(before[0].x_m, before[0].y_m, before[0].z_m), 1.0, 1e-6);
  EXPECT_NEAR(before[1].x_m, 20.0105, 0.009);
  EXPECT_NEAR(before[1].y_m, 0.1382, 0.009);
  EXPECT_NEAR(before[16].x_m, 19.5346, 0.009);
  const auto& after = heard.turns[1].sight->points;
  ASSERT_EQ(after.size(), 10 * kChannels);
  EXPECT_EQ(after[3 * kChannels + 17].echo, Echo::Unknown);
  const SightPoint& p = after[4 * kChannels + 30];
  EXPECT_NEAR(p.x_m, 20.4140, 0.009);
  EXPECT_NEAR(p.y_m, -0.3415, 0.009);
  EXPECT_NEAR(p.z_m, -0.3564, 0.009);
  EXPECT_EQ(p.intensity, 34);
  EXPECT_EQ(heard.turns[0].missing + heard.turns[1].missing, 3U);
  // Each piece counts its time from its own beginning.
  EXPECT_NEAR(base::seconds(heard.turns[1].sight->stamp - heard.turns[0].sight->stamp),
              2 * 110.592e-6, 1e-8);
  EXPECT_NEAR(p.after_s, (751.104 - 2 * 110.592) * 1e-6, 1e-7);
}

TEST(VelodyneTurns, AMissingReturnIsFreeOnlyAsFarAsSomebodyVouchesForIt) {
  Params params;
  params.clear_to_m = 8.0;
  params.min_range_m = 1.0;
  params.max_range_m = 30.0;
  Heard heard(params);
  Packet p = vector_a();
  p.blocks[0].channels[0].distance = 0;       // nothing
  p.blocks[0].channels[1].distance = 499;     // 0.998 m: too near to be believed
  p.blocks[0].channels[2].distance = 500;     // 1 m
  p.blocks[0].channels[3].distance = 15'001;  // 30.002 m: too far
  heard.revolutions.add(p, kArrival);
  heard.revolutions.finish();
  const auto& points = heard.points();
  EXPECT_EQ(heard.turns[0].sight->clear_to_m, 8.0F);
  EXPECT_EQ(points[0].echo, Echo::Clear);
  EXPECT_NEAR(std::hypot(points[0].x_m, points[0].y_m, points[0].z_m), 8.0, 1e-5);
  EXPECT_EQ(points[1].echo, Echo::Unknown);
  EXPECT_EQ(points[2].echo, Echo::Hit);
  EXPECT_EQ(points[3].echo, Echo::Clear);
  EXPECT_EQ(heard.turns[0].missing, 3U);
}

TEST(VelodyneTurns, TwoReturnsArePublishedOnceWhereTheyAreEqual) {
  Heard heard;
  Packet p = packet_of({.azimuth0 = 1000, .step = 0, .base = 1000}, 0, ReturnMode::Dual);
  for (std::size_t b = 0; b < kBlocks; ++b) {
    p.blocks[b].azimuth_cdeg = static_cast<std::uint16_t>(1000 + b / 2 * 40);
  }
  p.blocks[0].channels[5] = {2000, 7};   // last, farther; the odd one stays at 1000
  p.blocks[2].channels[0].distance = 0;  // only the odd one
  p.blocks[5].channels[1].distance = 0;  // only the even one
  p.blocks[6].channels[9].distance = p.blocks[7].channels[9].distance = 0;
  heard.revolutions.add(p, kArrival);
  heard.revolutions.finish();
  const auto& points = heard.points();
  ASSERT_EQ(points.size(), 6 * kChannels + 1);
  EXPECT_NEAR(std::hypot(points[5].x_m, points[5].y_m, points[5].z_m), 4.0, 1e-5);
  EXPECT_NEAR(std::hypot(points[6].x_m, points[6].y_m, points[6].z_m), 2.0, 1e-5);
  EXPECT_EQ(points[5].after_s, points[6].after_s);
  EXPECT_EQ(heard.turns[0].missing, 1U);
  EXPECT_EQ(heard.turns[0].firings, 192U);
  EXPECT_NEAR(points.back().after_s, (5 * 110.592 + 55.296 + 34.56) * 1e-6, 1e-7);
  EXPECT_NEAR(base::seconds(kArrival - heard.turns[0].sight->stamp), 663.552e-6, 1e-8);
}

TEST(VelodyneTurns, AHeadThatTurnsIsToldTurnByTurn) {
  Heard heard;
  Head head;
  Time now = kArrival;
  for (int i = 0; i < 76 * 3; ++i) {  // 75 packets a turn
    heard.revolutions.add(head.next(), now);
    now += 1327104ns;
  }
  ASSERT_EQ(heard.turns.size(), 3U);
  EXPECT_FALSE(heard.turns[0].whole) << "nobody saw it begin";
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_TRUE(heard.turns[i].whole);
    EXPECT_NEAR(heard.turns[i].duration_s, 0.0995328, 2e-6);
    EXPECT_EQ(heard.turns[i].sight->points.size(), 28'800U);
    EXPECT_EQ(heard.turns[i].sight->count, i);
    EXPECT_NEAR(base::seconds(heard.turns[i].sight->stamp - heard.turns[i - 1].sight->stamp),
                0.0995328, 5e-6);
  }
  EXPECT_EQ(heard.revolutions.counts().lost, 0U);
}

TEST(VelodyneTurns, LostRepeatedAndLatePacketsAreCountedOverTheTopOfTheHour) {
  Heard heard;
  Head head;
  head.stamp_us = kHour_us - 20'000;
  Time now = kArrival;
  std::vector<Packet> sent;
  for (int i = 0; i < 100; ++i) sent.push_back(head.next());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    now += 1327104ns;
    if (i == 10 || i == 11 || i == 15 || i == 50) continue;  // lost, one across the hour
    heard.revolutions.add(sent[i], now);
    if (i == 30) heard.revolutions.add(sent[i], now);
    if (i == 40) heard.revolutions.add(sent[35], now);
  }
  const auto& c = heard.revolutions.counts();
  EXPECT_EQ(c.packets, 96U);
  EXPECT_EQ(c.lost, 4U);
  EXPECT_EQ(c.duplicates, 1U);
  EXPECT_EQ(c.late, 1U);
  EXPECT_EQ(c.jumps, 0U);
}

TEST(VelodyneTurns, APacketThatHadToWaitMovesNoStamp) {
  Heard steady;
  Heard waiting;
  Head head;
  Time now = kArrival;
  for (int i = 0; i < 200; ++i) {
    now += 1327104ns;
    const Packet p = head.next();
    steady.revolutions.add(p, now);
    waiting.revolutions.add(p, now + (i % 7 == 3 ? 20ms : 0ms));
  }
  ASSERT_EQ(steady.turns.size(), waiting.turns.size());
  for (std::size_t i = 0; i < steady.turns.size(); ++i) {
    EXPECT_NEAR(base::seconds(waiting.turns[i].sight->stamp - steady.turns[i].sight->stamp), 0.0,
                1e-4);
  }
}

TEST(VelodyneTurns, AClockThatIsSetBeginsAnewAndTellsNoImpossibleTimes) {
  Heard heard;
  Head head;
  Time now = kArrival;
  for (int i = 0; i < 400; ++i) {
    if (i == 100) head.stamp_us += 1'500'000'000;
    if (i == 200) head.stamp_us = 5;
    now += 1327104ns;
    heard.revolutions.add(head.next(), now);
  }
  EXPECT_EQ(heard.revolutions.counts().jumps, 2U);
  EXPECT_EQ(heard.revolutions.counts().lost, 0U);
  for (const Turn& turn : heard.turns) {
    EXPECT_LT(turn.sight->stamp, now);
    EXPECT_GT(turn.sight->stamp, kArrival - 2ms);
    for (const SightPoint& p : turn.sight->points) {
      ASSERT_GE(p.after_s, 0.0F);
      ASSERT_LT(p.after_s, 0.2F);
    }
  }
}

TEST(VelodyneTurns, AHeadThatStandsIsToldInPiecesThatAreNoTurns) {
  Heard heard;
  Head head;
  Time now = kArrival;
  for (int i = 0; i < 2000; ++i) {
    now += 1327104ns;
    Packet p = head.next();
    for (Block& block : p.blocks) block.azimuth_cdeg = 9000;
    heard.revolutions.add(p, now);
  }
  ASSERT_EQ(heard.turns.size(), 5U);
  for (const Turn& turn : heard.turns) {
    EXPECT_FALSE(turn.whole);
    EXPECT_LT(turn.sight->points.size(), 150'000U);
  }
  EXPECT_EQ(heard.revolutions.counts().gaps, 2000U);
}

TEST(VelodyneTurns, AzimuthsThatMakeNoSenseDoNotMakeAThousandTurns) {
  Heard heard;
  Head head;
  Time now = kArrival;
  for (unsigned i = 0; i < 1000; ++i) {
    now += 1327104ns;
    Packet p = head.next();
    for (unsigned b = 0; b < kBlocks; ++b) {
      p.blocks[b].azimuth_cdeg = static_cast<std::uint16_t>((i * 7919U + b * 15013U) % kTurn_cdeg);
    }
    heard.revolutions.add(p, now);
  }
  EXPECT_LT(heard.turns.size(), 80U);
}

}  // namespace
}  // namespace roverd::velodyne
