// An MTi-G's receiver tells of samples that lie before the last inertial one:
//
//   inertial   -- 10 -- 20 -- 30 -- 40 -- 50 -- 60 -- ...
//   GNSS of         17 ..................... comes here, 40 ms to 2.5 s late

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "mti/interpreter.hpp"
#include "unit/mti/messages.hpp"
#include "unit/mti/words.hpp"

namespace roverd::mti {
namespace {

using namespace std::chrono_literals;

constexpr base::Duration kTick = 100us;

/// 100 inertial samples a second, and a receiver whose word comes `late` after its sample.
class UnitWithReceiver {
 public:
  explicit UnitWithReceiver(const Params& p)
      : interpreter("mti", p,
                    {[this](const base::Measurement& m) { heard.push_back(m); },
                     [this](std::string_view c, std::uint64_t n) { refused[std::string(c)] += n; },
                     [this](std::string_view c, std::uint64_t n) { noted[std::string(c)] += n; }}) {
    const auto whole = from_hex(kPvt);
    const Data2 data = decode_data2(Bytes(whole).subspan(4, 0x61));
    pvt.assign(data.packets.at(0).bytes.begin(), data.packets.at(0).bytes.end());
  }

  void inertial() {
    count += 100;
    Word w;
    w.count = count;
    w.number = number++;
    interpreter.take(w.builder().payload(), at(count));
  }
  /// The receiver's word on the sample that lies so far before the newest one.
  bool receiver(base::Duration late) { return receiver_of(count_before(late)); }
  bool receiver_of(std::uint32_t sample) {
    Data2Builder b;
    b.bytes(xdi_of(Kind::GnssPvt), pvt)
        .integer(xdi_of(Kind::SampleTimeFine), sample, 4)
        .integer(xdi_of(Kind::PacketCounter), number++, 2);
    return interpreter.take(b.payload(), at(count) + 1ms);
  }
  bool satellites(base::Duration late) {
    Data2Builder b;
    b.bytes(xdi_of(Kind::GnssSatellites),
            std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 5, 41, 8})
        .integer(xdi_of(Kind::SampleTimeFine), count_before(late), 4)
        .integer(xdi_of(Kind::PacketCounter), number++, 2);
    return interpreter.take(b.payload(), at(count) + 1ms);
  }
  std::uint32_t count_before(base::Duration late) const {
    return count - static_cast<std::uint32_t>(late / kTick);
  }
  /// The bytes of a sample arrive 3 ms after it.
  base::Time at(std::uint32_t sample) const {
    return base::Time{100s + kTick * static_cast<std::int32_t>(sample - kFirst) + 3ms};
  }

  static constexpr std::uint32_t kFirst = 0xFFFF'F000;  // wraps within half a second
  std::vector<base::Measurement> heard;
  std::map<std::string, std::uint64_t> refused;
  std::map<std::string, std::uint64_t> noted;
  std::vector<std::uint8_t> pvt;
  Interpreter interpreter;
  std::uint32_t count = kFirst;
  std::uint16_t number = 65'000;
};

TEST(MtiLateGnss, PositionsOfEarlierSamplesAreToldWithTheirOwnTime) {
  for (const base::Duration late : {40ms, 46ms, 300ms, 2500ms}) {
    UnitWithReceiver u({.position = "gnss"});
    for (int i = 0; i < 400; ++i) u.inertial();
    for (int epoch = 0; epoch < 8; ++epoch) {
      for (int i = 0; i < 25; ++i) u.inertial();
      ASSERT_TRUE(u.receiver(late)) << late.count();
      ASSERT_TRUE(u.satellites(late)) << late.count();
    }
    const auto fixes = all_of<base::GnssFix>(u.heard);
    ASSERT_EQ(fixes.size(), 8u);
    for (std::size_t k = 0; k < fixes.size(); ++k) {
      const auto sample =
          static_cast<std::uint32_t>(UnitWithReceiver::kFirst + 40'000 + 2500 * (k + 1)) -
          static_cast<std::uint32_t>(late / kTick);
      EXPECT_EQ(fixes[k].stamp, u.at(sample)) << late.count();
      EXPECT_EQ(fixes[k].latency_s, 0.0);
      EXPECT_NEAR(fixes[k].position->lat, -33.5, 1e-9);
    }
    const auto velocities = all_of<base::GnssVelocity>(u.heard);
    ASSERT_EQ(velocities.size(), 8u);
    EXPECT_EQ(velocities[3].stamp, fixes[3].stamp);
    EXPECT_EQ(velocities[3].latency_s, 0.0);
    EXPECT_EQ(all_of<base::SatellitesInView>(u.heard).size(), 8u);
    EXPECT_EQ(all_of<base::Inertial>(u.heard).size(), 600u);
    EXPECT_TRUE(u.refused.empty()) << u.refused.begin()->first;
    EXPECT_EQ(u.noted.count("message lost on the way"), 0u);
  }
}

TEST(MtiLateGnss, InertialStampsStayAsEvenAsTheSamples) {
  UnitWithReceiver u({.position = "gnss"});
  for (int i = 0; i < 300; ++i) {
    u.inertial();
    if (i % 25 == 24) u.receiver(800ms);
  }
  const auto all = all_of<base::Inertial>(u.heard);
  ASSERT_EQ(all.size(), 300u);
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_EQ(all[i].stamp - all[i - 1].stamp, 10ms);
}

TEST(MtiLateGnss, OnlyRealGapsCountAsLost) {
  UnitWithReceiver u({.position = "gnss"});
  for (int i = 0; i < 2000; ++i) {  // the number wraps
    u.inertial();
    if (i % 25 == 24) u.receiver(46ms);
    if (i == 1000) u.number = static_cast<std::uint16_t>(u.number + 3);  // three did not come
  }
  EXPECT_EQ(u.noted["message lost on the way"], 3u);
}

TEST(MtiLateGnss, AUnitThatNumbersBySampleLosesNothingEither) {
  UnitWithReceiver u({.position = "gnss"});
  for (int i = 0; i < 500; ++i) {
    u.inertial();
    if (i % 25 != 24) continue;
    const std::uint16_t newest = u.number;
    u.number = static_cast<std::uint16_t>(newest - 1 - 30);  // of the sample it tells of
    ASSERT_TRUE(u.receiver(300ms));
    u.number = newest;
  }
  EXPECT_EQ(u.noted.count("message lost on the way"), 0u);
}

TEST(MtiLateGnss, BeforeTheFirstInertialSampleItIsStampedByArrivalAndSaysNoLatency) {
  UnitWithReceiver u({.position = "gnss"});
  ASSERT_TRUE(u.receiver(46ms));
  const auto fix = all_of<base::GnssFix>(u.heard).at(0);
  EXPECT_EQ(fix.stamp, u.at(u.count) + 1ms);
  EXPECT_FALSE(fix.latency_s);
  // And the inertial sample of the same time that comes next is none that stands still.
  u.inertial();
  EXPECT_EQ(all_of<base::Inertial>(u.heard).size(), 1u);
  EXPECT_TRUE(u.refused.empty());
}

TEST(MtiLateGnss, ARepeatedOneOrOneOfLongAgoIsRefusedAndMovesNothing) {
  UnitWithReceiver u({.position = "gnss"});
  for (int i = 0; i < 700; ++i) u.inertial();
  const std::uint32_t sample = u.count_before(46ms);
  ASSERT_TRUE(u.receiver_of(sample));
  EXPECT_FALSE(u.receiver_of(sample));
  EXPECT_FALSE(u.receiver_of(sample - 2500));
  EXPECT_FALSE(u.receiver(5100ms));
  EXPECT_FALSE(u.receiver_of(u.count + 60'000));  // six seconds ahead
  EXPECT_EQ(u.refused["GNSS sample time not going on"], 2u);
  EXPECT_EQ(u.refused["GNSS message of a sample that is long past"], 2u);
  EXPECT_EQ(all_of<base::GnssFix>(u.heard).size(), 1u);
  u.inertial();
  const auto all = all_of<base::Inertial>(u.heard);
  ASSERT_EQ(all.size(), 701u);
  EXPECT_EQ(all[700].stamp - all[699].stamp, 10ms);
}

TEST(MtiLateGnss, AUnitThatBeganAnewIsHeardAgainWithItsReceiver) {
  UnitWithReceiver u({.position = "gnss"});
  for (int i = 0; i < 100; ++i) u.inertial();
  ASSERT_TRUE(u.receiver(46ms));
  const std::uint32_t before = u.count;
  u.count = 20'000;  // 2 s after its own beginning
  u.number = 200;
  const base::Time now = u.at(before) + 3s;
  const auto inertial = [&](base::Duration later) {
    Word w;
    w.count = u.count += 100;
    w.number = u.number++;
    return u.interpreter.take(w.builder().payload(), now + later);
  };
  ASSERT_GT(static_cast<std::int32_t>(u.count - before), 0);  // it looks like a jump ahead: 2 s
  EXPECT_TRUE(inertial(0ms));
  EXPECT_TRUE(inertial(10ms));
  Data2Builder b;
  b.bytes(xdi_of(Kind::GnssPvt), u.pvt).integer(xdi_of(Kind::SampleTimeFine), u.count - 500, 4);
  EXPECT_TRUE(u.interpreter.take(b.payload(), now + 11ms));
  const auto fix = all_of<base::GnssFix>(u.heard).back();
  EXPECT_NEAR(base::seconds(now + 10ms - fix.stamp), 0.05, 1e-3);
}

TEST(MtiLateGnss, TheFiltersPositionIsOfItsSampleToo) {
  UnitWithReceiver u({.position = "filter"});
  u.inertial();
  Word w;
  w.status = kWithFix;
  w.count = u.count + 100;
  w.number = u.number;
  Data2Builder b = w.builder();
  b.numbers(xdi_of(Kind::LatLon, Axes::Enu, Format::Fp1632), {58.0, 26.0});
  ASSERT_TRUE(u.interpreter.take(b.payload(), u.at(w.count)));
  EXPECT_EQ(all_of<base::GnssFix>(u.heard).at(0).latency_s, 0.0);
  EXPECT_EQ(all_of<base::GnssFix>(u.heard).at(0).stamp, u.at(w.count));
}

}  // namespace
}  // namespace roverd::mti
