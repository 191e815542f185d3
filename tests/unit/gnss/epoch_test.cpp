#include "gnss/epoch.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "gnss/nmea.hpp"
#include "gnss/nmea_encode.hpp"

namespace roverd::gnss {
namespace {

using namespace std::chrono_literals;
using base::FixType;

class EpochTest : public ::testing::Test {
 protected:
  /// A sentence 5 ms after the one before.
  void say(const std::string& body) {
    now += 5ms;
    std::string text = line(body);
    text.resize(text.size() - 2);
    const Parsed p = parse_line(text);
    ASSERT_EQ(p.kind, Kind::Used) << body;
    epochs.add(p.sentence, now);
  }
  void gga(const std::string& time, int quality = 4) {
    say("GNGGA," + time + ",5822.6812,N,02643.7340,E," + std::to_string(quality) +
        ",17,0.6,58.3,M,21.7,M,1.2,0042");
  }
  void rmc(const std::string& time, const std::string& motion = "2.0,90.0",
           const std::string& date = "010326", const std::string& status = "A") {
    say("GNRMC," + time + "," + status + ",5822.6812,N,02643.7340,E," + motion + "," + date +
        ",,,R,V");
  }
  void gst(const std::string& time) {
    say("GNGST," + time + ",1.9,0.014,0.009,38.5,0.012,0.010,0.021");
  }
  /// Two whole epochs, so that the third is told with its last sentence.
  void learn() {
    for (const char* time : {"100000.00", "100000.20", "100000.40"}) {
      gga(time);
      rmc(time);
      gst(time);
      now += 185ms;
    }
    seen.clear();
  }

  template <class M>
  std::vector<M> told() const {
    std::vector<M> out;
    for (const auto& m : seen) {
      if (const M* value = std::get_if<M>(&m)) out.push_back(*value);
    }
    return out;
  }
  std::vector<base::GnssFix> fixes() const { return told<base::GnssFix>(); }
  std::vector<base::GnssVelocity> velocities() const { return told<base::GnssVelocity>(); }

  std::vector<base::Measurement> seen;
  EpochAssembler epochs{EpochOptions{}, [this](const base::Measurement& m) { seen.push_back(m); }};
  Time now = Time{} + 500s;
};

TEST_F(EpochTest, TheFirstEpochIsToldWhenTheNextBegins) {
  gga("100000.00");
  const Time first = now;
  rmc("100000.00");
  gst("100000.00");
  EXPECT_TRUE(seen.empty());
  gga("100000.20");
  ASSERT_EQ(fixes().size(), 1u);
  const base::GnssFix fix = fixes()[0];
  EXPECT_EQ(fix.stamp, first) << "the arrival of its first byte";
  EXPECT_EQ(fix.fix, FixType::RtkFixed);
  EXPECT_NEAR(fix.position->lat, 58.37802, 1e-9);
  EXPECT_NEAR(fix.position->lon, 26.7289, 1e-9);
  EXPECT_EQ(fix.alt_msl_m, 58.3);
  EXPECT_EQ(fix.geoid_sep_m, 21.7);
  EXPECT_EQ(fix.satellites, 17);
  EXPECT_EQ(fix.hdop, 0.6);
  EXPECT_EQ(fix.correction_age_s, 1.2);
  EXPECT_EQ(fix.sigma_east_m, 0.010) << "of longitude";
  EXPECT_EQ(fix.sigma_north_m, 0.012) << "of latitude";
  EXPECT_EQ(base::to_rfc3339(fix.utc.value()), "2026-03-01T10:00:00.000Z");
}

TEST_F(EpochTest, VelocityComesInMetresPerSecondEastAndNorth) {
  gga("100000.00");
  rmc("100000.00", "2.0,30.0");
  gga("100000.20");
  ASSERT_EQ(velocities().size(), 1u);
  const double v = 2.0 * 1852.0 / 3600.0;
  EXPECT_NEAR(velocities()[0].east_mps, v * 0.5, 1e-12);
  EXPECT_NEAR(velocities()[0].north_mps, v * std::sqrt(3.0) / 2.0, 1e-12);
  EXPECT_EQ(velocities()[0].stamp, fixes()[0].stamp);
}

TEST_F(EpochTest, ALearnedEpochIsToldWithItsLastSentence) {
  learn();
  gga("100000.60");
  rmc("100000.60");
  EXPECT_TRUE(seen.empty());
  gst("100000.60");
  EXPECT_EQ(fixes().size(), 1u);
  EXPECT_EQ(velocities().size(), 1u);
  gga("100000.80");
  EXPECT_EQ(fixes().size(), 1u) << "and only once";
}

TEST_F(EpochTest, ACycleThatChangesIsLearnedAgain) {
  learn();
  for (const char* time : {"100000.60", "100000.80", "100001.00"}) {
    gga(time);
    rmc(time);  // GST comes no more
  }
  // Then the first two are told by the next, as GST may still come, and the third with its RMC.
  ASSERT_EQ(fixes().size(), 3u);
  gga("100001.20");
  EXPECT_EQ(fixes().size(), 3u);
  rmc("100001.20");
  EXPECT_EQ(fixes().size(), 4u);
}

TEST_F(EpochTest, AnEpochThatStaysIncompleteIsToldAfterATimeOut) {
  learn();
  gga("100000.60");
  epochs.tick(now + 250ms);
  EXPECT_TRUE(seen.empty());
  epochs.tick(now + 251ms);
  ASSERT_EQ(fixes().size(), 1u);
  EXPECT_EQ(fixes()[0].sigma_east_m, std::nullopt);
  epochs.tick(now + 10s);
  EXPECT_EQ(fixes().size(), 1u);
}

TEST_F(EpochTest, SatelliteSentencesKeepAnEpochOpen) {
  learn();
  gga("100000.60");
  for (int i = 0; i < 5; ++i) {
    now += 100ms;
    say("GPGSV,1,1,00");
    epochs.tick(now + 100ms);
  }
  EXPECT_TRUE(seen.empty());
}

TEST_F(EpochTest, ALateRmcStillGivesTheVelocity) {
  learn();
  gga("100000.60");
  const Time first = now;
  epochs.tick(now + 251ms);
  EXPECT_TRUE(velocities().empty());
  now += 300ms;
  rmc("100000.60");
  ASSERT_EQ(velocities().size(), 1u);
  EXPECT_EQ(velocities()[0].stamp, first);
}

TEST_F(EpochTest, AReceiverWithGgaAloneHasPositionsOnly) {
  for (const char* time : {"100000", "100001", "100002", "100003"}) gga(time, 1);
  EXPECT_EQ(fixes().size(), 4u) << "one behind, then at once";
  EXPECT_TRUE(velocities().empty());
  EXPECT_EQ(fixes()[3].utc, std::nullopt) << "no date";
}

TEST_F(EpochTest, AReceiverWithRmcAloneHasPositionsToo) {
  rmc("100000");
  rmc("100001", "0.0,");
  rmc("100002");
  ASSERT_EQ(fixes().size(), 3u);
  EXPECT_EQ(fixes()[0].fix, FixType::RtkFixed) << "mode R";
  EXPECT_TRUE(fixes()[0].position);
  EXPECT_EQ(fixes()[0].satellites, std::nullopt);
}

TEST_F(EpochTest, WithoutGgaGnsGivesThePosition) {
  say("GNGNS,100000,5822.6812,N,02643.7340,E,FA,17,0.6,58.3,21.7,,,V");
  say("GNGNS,100001,5822.6812,N,02643.7340,E,FA,17,0.6,58.3,21.7,,,V");
  ASSERT_EQ(fixes().size(), 1u);
  EXPECT_EQ(fixes()[0].fix, FixType::RtkFloat);
  EXPECT_EQ(fixes()[0].alt_msl_m, 58.3);
}

TEST_F(EpochTest, QualityZeroIsNoPositionWhateverTheFieldsSay) {
  say("GPGGA,100000,0000.0000,N,00000.0000,E,0,00,99.9,0.0,M,0.0,M,,");
  say("GPGGA,100001,5822.6812,N,02643.7340,E,0,00,99.9,4.0,M,42.2,M,,");
  say("GPGGA,100002,,,,,0,00,99.9,,,,,,");
  say("GPGGA,100003,,,,,0,00,99.9,,,,,,");
  ASSERT_EQ(fixes().size(), 4u);
  for (const base::GnssFix& fix : fixes()) {
    EXPECT_EQ(fix.fix, FixType::None);
    EXPECT_EQ(fix.position, std::nullopt);
    EXPECT_EQ(fix.alt_msl_m, std::nullopt);
    EXPECT_EQ(fix.satellites, 0);
  }
}

TEST_F(EpochTest, NullIslandWithAFixIsAPosition) {
  say("GPGGA,100000,0000.0000,N,00000.0000,E,1,08,1.0,0.0,M,0.0,M,,");
  gga("100001");
  EXPECT_EQ(fixes().at(0).position, (base::LatLon{0.0, 0.0}));
}

TEST_F(EpochTest, AVoidRmcOverrulesItsGga) {
  for (const char* status : {"V", "A"}) {
    epochs.reset();
    seen.clear();
    gga("100000.00", 1);
    say(std::string("GNRMC,100000.00,") + status + ",5822.6812,N,02643.7340,E,2.0,90.0,010326,,,N");
    gga("100001.00", 1);
    ASSERT_EQ(fixes().size(), 1u);
    EXPECT_EQ(fixes()[0].fix, FixType::None);
    EXPECT_EQ(fixes()[0].position, std::nullopt);
    EXPECT_TRUE(velocities().empty());
  }
}

TEST_F(EpochTest, ManualAndSimulatedPositionsAreNotUsed) {
  for (const int quality : {7, 8, 9}) {
    gga("10000" + std::to_string(quality), quality);
  }
  epochs.reset();
  for (const base::GnssFix& fix : fixes()) {
    EXPECT_EQ(fix.fix, FixType::Unknown);
    EXPECT_EQ(fix.position, std::nullopt);
  }
  EXPECT_EQ(fixes().size(), 3u);
}

TEST_F(EpochTest, ASigmaOfZeroIsNone) {
  gga("100000");
  say("GNGST,100000,,,,,0.0,0.010,0.0");
  gga("100001");
  EXPECT_EQ(fixes().at(0).sigma_north_m, std::nullopt);
  EXPECT_EQ(fixes().at(0).sigma_east_m, 0.010);
}

TEST_F(EpochTest, NoCourseAndHardlyASpeedIsNoFasterThanThat) {
  gga("100000");
  rmc("100000", "0.1,");
  gga("100001");
  ASSERT_EQ(velocities().size(), 1u);
  EXPECT_EQ(velocities()[0].east_mps, 0.0);
  EXPECT_EQ(velocities()[0].north_mps, 0.0);
  EXPECT_NEAR(velocities()[0].sigma_mps.value(), 0.1 * 1852.0 / 3600.0, 1e-12);
}

TEST_F(EpochTest, NoCourseAndNoSpeedIsStandingStill) {
  gga("100000");
  rmc("100000", "0.0,");
  gga("100001");
  ASSERT_EQ(velocities().size(), 1u);
  EXPECT_EQ(velocities()[0].east_mps, 0.0);
  EXPECT_FALSE(velocities()[0].sigma_mps);
}

TEST_F(EpochTest, NoCourseAtSpeedIsNoVelocity) {
  gga("100000");
  rmc("100000", "2.0,");
  gga("100001");
  EXPECT_TRUE(velocities().empty());
}

TEST_F(EpochTest, WithoutRmcVtgGivesTheVelocity) {
  gga("100000");
  say("GNVTG,90.0,T,,M,2.0,N,3.7,K,R");
  gga("100001");
  ASSERT_EQ(velocities().size(), 1u);
  EXPECT_NEAR(velocities()[0].east_mps, 2.0 * 1852.0 / 3600.0, 1e-12);
  EXPECT_NEAR(velocities()[0].north_mps, 0.0, 1e-12);
}

TEST_F(EpochTest, AVtgOfModeNIsNoVelocity) {
  gga("100000");
  say("GNVTG,90.0,T,,M,2.0,N,3.7,K,N");
  gga("100001");
  EXPECT_TRUE(velocities().empty());
}

TEST_F(EpochTest, AVtgWithARateOfItsOwnCountsByItself) {
  for (const char* time : {"100000", "100001", "100002"}) {
    gga(time);
    say("GNVTG,90.0,T,,M,2.0,N,3.7,K,R");
  }
  seen.clear();
  now += 100ms;
  say("GNVTG,0.0,T,,M,2.0,N,3.7,K,R");
  ASSERT_EQ(velocities().size(), 1u);
  EXPECT_EQ(velocities()[0].stamp, now);
}

TEST_F(EpochTest, HeadingBecomesYawWithTheEpochsStamp) {
  gga("100000");
  const Time first = now;
  say("GNHDT,90.0,T");
  ASSERT_EQ(seen.size(), 1u) << "at once";
  const auto heading = std::get<base::Heading>(seen[0]);
  EXPECT_NEAR(heading.yaw_rad, 0.0, 1e-12);
  EXPECT_EQ(heading.stamp, first);
  EXPECT_EQ(heading.source, base::HeadingSource::Compass);
  say("GNTHS,0.0,A");
  EXPECT_NEAR(std::get<base::Heading>(seen[1]).yaw_rad, base::kPi / 2, 1e-12);
  EXPECT_EQ(std::get<base::Heading>(seen[1]).stamp, now) << "the second has its own";
}

TEST_F(EpochTest, AVoidHeadingIsNotTold) {
  say("GNTHS,12.0,V");
  say("GNHDT,,T");
  EXPECT_TRUE(seen.empty());
}

TEST(EpochHeading, CarriesItsSourceAndMountingAngle) {
  std::vector<base::Heading> headings;
  EpochAssembler epochs(
      {.heading_source = base::HeadingSource::DualAntenna, .heading_offset_deg = -90.0},
      [&](const base::Measurement& m) { headings.push_back(std::get<base::Heading>(m)); });
  epochs.add(Hdt{.heading_deg = 180.0}, Time{});
  ASSERT_EQ(headings.size(), 1u);
  EXPECT_NEAR(headings[0].yaw_rad, 0.0, 1e-12) << "antennas across: east";
  EXPECT_EQ(headings[0].source, base::HeadingSource::DualAntenna);
}

TEST_F(EpochTest, TheDateIsCarriedOverMidnight) {
  // RMC 235959.8 of 28 Feb ─▶ GGA 000000.0 before any new date
  gga("235959.80");
  rmc("235959.80", "0.0,", "280226");
  gga("000000.00");
  gga("000000.20");
  ASSERT_EQ(fixes().size(), 2u);
  EXPECT_EQ(base::to_rfc3339(fixes()[0].utc.value()), "2026-02-28T23:59:59.800Z");
  EXPECT_EQ(base::to_rfc3339(fixes()[1].utc.value()), "2026-03-01T00:00:00.000Z");
  rmc("000000.20", "0.0,", "010326");
  gga("000000.40");
  EXPECT_EQ(base::to_rfc3339(fixes()[2].utc.value()), "2026-03-01T00:00:00.200Z");
}

TEST_F(EpochTest, ADateThatCameAfterMidnightIsNotGivenToAnEpochBeforeIt) {
  gga("235959.80");
  say("GNZDA,000000.00,01,03,2026,00,00");
  ASSERT_EQ(fixes().size(), 1u);
  EXPECT_EQ(base::to_rfc3339(fixes()[0].utc.value()), "2026-02-28T23:59:59.800Z");
}

TEST_F(EpochTest, ALeapSecondIsTheEndOfItsDay) {
  gga("235960.00");
  rmc("235960.00", "0.0,", "311216");
  gga("000000.00");
  EXPECT_EQ(base::to_rfc3339(fixes().at(0).utc.value()), "2017-01-01T00:00:00.000Z");
}

TEST_F(EpochTest, AReceiverWithoutTimeIsStillHeard) {
  for (int i = 0; i < 3; ++i) say("GNGGA,,5822.6812,N,02643.7340,E,1,08,1.0,58.3,M,21.7,M,,");
  EXPECT_EQ(fixes().size(), 3u);
  EXPECT_EQ(fixes()[0].utc, std::nullopt);
}

TEST_F(EpochTest, TimesThatDifferInTheirDecimalsOnlyAreOneEpoch) {
  gga("100000.20");
  rmc("100000.200");
  gga("100000.40");
  EXPECT_EQ(fixes().size(), 1u);
  EXPECT_EQ(velocities().size(), 1u);
}

}  // namespace
}  // namespace roverd::gnss
