// GSV, GSA and NAV-SAT to one list of satellites.

#include "gnss/sky.hpp"

#include <gtest/gtest.h>

#include "gnss/nmea.hpp"
#include "gnss/nmea_encode.hpp"

namespace roverd::gnss {
namespace {

using namespace std::chrono_literals;

class SkyTest : public ::testing::Test {
 protected:
  void say(const std::string& body) {
    const std::string whole = line(body);
    const Parsed p = parse_line(std::string_view(whole).substr(0, whole.size() - 2));
    EXPECT_EQ(p.kind, Kind::Used) << body;
    sky.add(p.sentence, now);
  }
  void pause() {
    now += 400ms;
    sky.tick(now);
  }
  const base::Satellite* find(const std::string& system, int number) const {
    if (told.empty()) return nullptr;
    for (const auto& s : *told.back().satellites) {
      if (s.system == system && s.number == number) return &s;
    }
    return nullptr;
  }

  Time now{100s};
  std::vector<base::SatellitesInView> told;
  Sky sky{"gnss", [this](const base::Measurement& m) {
            told.push_back(std::get<base::SatellitesInView>(m));
          }};
};

TEST_F(SkyTest, ASweepIsToldAfterItsPause) {
  say("GPGSV,1,1,02,05,45,123,38,12,10,300,,1");
  sky.tick(now + 100ms);
  EXPECT_TRUE(told.empty());
  pause();
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].driver, "gnss");
  EXPECT_EQ(told[0].stamp, Time{100s});
  ASSERT_TRUE(find("gps", 5) && find("gps", 12));
  EXPECT_EQ(find("gps", 5)->elevation_deg, 45.0);
  EXPECT_EQ(find("gps", 5)->azimuth_deg, 123.0);
  EXPECT_EQ(find("gps", 5)->cn0_dbhz, 38.0);
  EXPECT_FALSE(find("gps", 12)->cn0_dbhz) << "in view, not tracked";
  EXPECT_FALSE(find("gps", 5)->used) << "no GSA: nobody knows";
}

TEST_F(SkyTest, TwoSignalsOfASatelliteAreOneWithTheStronger) {
  say("GPGSV,1,1,01,05,45,123,38,1");
  say("GPGSV,1,1,01,05,45,123,44,6");
  pause();
  ASSERT_EQ(told.back().satellites->size(), 1u);
  EXPECT_EQ(find("gps", 5)->cn0_dbhz, 44.0);
}

TEST_F(SkyTest, TheNextSweepEndsTheOneBefore) {
  say("GPGSV,1,1,01,05,45,123,38,1");
  say("GPGSV,1,1,01,07,45,123,38,1");
  ASSERT_EQ(told.size(), 1u);
  EXPECT_TRUE(find("gps", 5));
  pause();
  ASSERT_EQ(told.size(), 2u);
  EXPECT_FALSE(find("gps", 5)) << "replaced, not added";
}

TEST_F(SkyTest, GsaSaysWhatIsUsedBySystem) {
  say("GNGSA,A,3,05,,,,,,,,,,,,1.2,0.7,1.0,1");
  say("GNGSA,A,3,65,,,,,,,,,,,,1.2,0.7,1.0,2");
  say("GPGSV,1,1,02,05,45,123,38,12,10,300,30,1");
  say("GLGSV,1,1,02,65,20,050,31,66,30,060,,1");
  pause();
  EXPECT_EQ(find("gps", 5)->used, true);
  EXPECT_EQ(find("gps", 12)->used, false);
  EXPECT_EQ(find("glonass", 1)->used, true);
  EXPECT_EQ(find("glonass", 2)->used, false);
  // A new list replaces the old one.
  say("GNGSA,A,3,12,,,,,,,,,,,,1.2,0.7,1.0,1");
  say("GPGSV,1,1,02,05,45,123,38,12,10,300,30,1");
  pause();
  EXPECT_EQ(find("gps", 5)->used, false);
  EXPECT_EQ(find("gps", 12)->used, true);
}

TEST_F(SkyTest, OldNumbersBelongToTheirSystems) {
  const Talker gn{};
  const Talker gp{{'G', 'P'}};
  const Talker gb{{'G', 'B'}};
  const Talker ga{{'G', 'A'}};
  EXPECT_EQ(satellite_name(gn, {}, 7), (SatelliteName{"gps", 7}));
  EXPECT_EQ(satellite_name(gp, {}, 33), (SatelliteName{"sbas", 120}));
  EXPECT_EQ(satellite_name(gp, {}, 193), (SatelliteName{"qzss", 1}));
  EXPECT_EQ(satellite_name(gn, {}, 74), (SatelliteName{"glonass", 10}));
  EXPECT_EQ(satellite_name(gb, {}, 40), (SatelliteName{"beidou", 40})) << "not SBAS";
  EXPECT_EQ(satellite_name(gb, {}, 205), (SatelliteName{"beidou", 5}));
  EXPECT_EQ(satellite_name(ga, {}, 36), (SatelliteName{"galileo", 36})) << "not SBAS";
  EXPECT_EQ(satellite_name(gn, {}, 301), (SatelliteName{"galileo", 1}));
  EXPECT_EQ(satellite_name(gn, 3, 12), (SatelliteName{"galileo", 12}));
  EXPECT_EQ(satellite_name(gn, {}, 999), (SatelliteName{"unknown", 999}));
}

TEST_F(SkyTest, NavSatOutranksGsvWhileItComes) {
  ubx::NavSat sats;
  sats.all.push_back({2, 11, 41, 50, 200, 0x0F});
  sats.all.push_back({6, 255, 0, -91, 0, 0x01});
  sky.add(sats, now);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(find("galileo", 11)->used, true);
  EXPECT_EQ(find("galileo", 11)->elevation_deg, 50.0);
  EXPECT_FALSE(find("glonass", 255)->elevation_deg) << "-91: not known";
  EXPECT_FALSE(find("glonass", 255)->cn0_dbhz);
  say("GPGSV,1,1,01,05,45,123,38,1");
  pause();
  EXPECT_EQ(told.size(), 1u);
  now += 6s;
  say("GPGSV,1,1,01,05,45,123,38,1");
  pause();
  EXPECT_EQ(told.size(), 2u);
}

ubx::NavSig signals_of_two() {
  ubx::NavSig sig;
  sig.all.push_back({2, 11, 0, 41, 7, 0x39, 0.1});  // E1 C, all used
  sig.all.push_back({2, 11, 6, 36, 7, 0x01, 0.2});  // E5b Q, tracked only
  sig.all.push_back({0, 5, 77, 0, 1, 0x00, 0.0});   // a signal to come, not heard yet
  return sig;
}

TEST_F(SkyTest, NavSigGivesEachSatelliteOfNavSatItsSignals) {
  ubx::NavSat sats;
  sats.all.push_back({2, 11, 41, 50, 200, 0x0F});
  sats.all.push_back({6, 3, 30, 20, 10, 0x00});
  sky.add(sats, now);
  EXPECT_TRUE(find("galileo", 11)->signals.empty());
  sky.add(signals_of_two(), now);
  ASSERT_EQ(told.size(), 2u);
  ASSERT_EQ(told.back().satellites->size(), 2u) << "GPS 5 is not in NAV-SAT";
  const auto& signals = find("galileo", 11)->signals;
  ASSERT_EQ(signals.size(), 2u);
  EXPECT_EQ(signals[0].name, "E1 C");
  EXPECT_EQ(signals[0].cn0_dbhz, 41.0);
  EXPECT_TRUE(signals[0].used);
  EXPECT_EQ(signals[1].name, "E5b Q");
  EXPECT_EQ(signals[1].cn0_dbhz, 36.0);
  EXPECT_FALSE(signals[1].used);
  EXPECT_EQ(find("galileo", 11)->elevation_deg, 50.0);
  EXPECT_TRUE(find("glonass", 3)->signals.empty());
  // The next NAV-SAT keeps them, once; after five seconds they are old.
  now += 1s;
  sky.add(sats, now);
  EXPECT_EQ(find("galileo", 11)->signals.size(), 2u);
  now += 4s;
  sky.add(sats, now);
  EXPECT_TRUE(find("galileo", 11)->signals.empty());
}

TEST_F(SkyTest, NavSigAloneTellsSatellitesWithoutAPlace) {
  sky.add(signals_of_two(), now);
  ASSERT_EQ(told.back().satellites->size(), 2u);
  EXPECT_EQ(find("galileo", 11)->cn0_dbhz, 41.0) << "of the stronger";
  EXPECT_EQ(find("galileo", 11)->used, true) << "one of its signals is";
  EXPECT_FALSE(find("galileo", 11)->elevation_deg);
  EXPECT_FALSE(find("gps", 5)->cn0_dbhz);
  EXPECT_EQ(find("gps", 5)->used, false);
  EXPECT_EQ(find("gps", 5)->signals.at(0).name, "signal 77");
  EXPECT_FALSE(find("gps", 5)->signals.at(0).cn0_dbhz);
  sky.reset();
  ubx::NavSat none;
  sky.add(none, now);
  EXPECT_TRUE(told.back().satellites->empty());
}

}  // namespace
}  // namespace roverd::gnss
