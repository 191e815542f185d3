// UBX epochs to measurements, and both languages of one receiver to one stream of them.

#include "gnss/ubx_epoch.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "../ubx/frames.hpp"
#include "base/angle.hpp"
#include "gnss/blend.hpp"
#include "gnss/epoch.hpp"

namespace roverd::gnss {
namespace {

using namespace std::chrono_literals;

ubx::Message message_of(std::string_view hex) {
  const auto frame = ubx::from_hex(hex);
  return ubx::decode(ubx::opened(frame)).message;
}

template <class M>
std::vector<M> all_of(const std::vector<base::Measurement>& said) {
  std::vector<M> out;
  for (const auto& m : said) {
    if (const M* value = std::get_if<M>(&m)) out.push_back(*value);
  }
  return out;
}

class UbxEpochTest : public ::testing::Test {
 protected:
  void hear(std::string_view hex, Time at) { epochs.add(message_of(hex), at); }
  /// The same message of a later epoch.
  void hear_later(std::string_view hex, std::uint32_t after_ms, Time at) {
    ubx::Message m = message_of(hex);
    if (auto* pvt = std::get_if<ubx::NavPvt>(&m)) pvt->itow_ms += after_ms;
    if (auto* precise = std::get_if<ubx::NavHpPosLlh>(&m)) precise->itow_ms += after_ms;
    if (auto* cov = std::get_if<ubx::NavCov>(&m)) cov->itow_ms += after_ms;
    epochs.add(m, at);
  }
  std::vector<base::GnssFix> fixes() const { return all_of<base::GnssFix>(said); }

  UbxEpochOptions options{
      .timeout_s = 0.25, .baseline_m = 1.0, .baseline_tolerance = 0.05, .heading_offset_deg = 90.0};
  std::vector<base::Measurement> said;
  UbxEpochs epochs{options, [this](const base::Measurement& m) { said.push_back(m); }};
  Time t0 = Time{} + 100s;
};

TEST_F(UbxEpochTest, APvtAloneIsAFixWithVelocityAndAccuracy) {
  hear(ubx::kPvtFixed, t0);
  EXPECT_TRUE(said.empty()) << "more of this epoch may come";
  epochs.tick(t0 + 251ms);
  ASSERT_EQ(fixes().size(), 1u);
  const base::GnssFix fix = fixes()[0];
  EXPECT_EQ(fix.stamp, t0);
  EXPECT_EQ(fix.fix, base::FixType::RtkFixed);
  EXPECT_NEAR(fix.position->lat, -33.8687243, 1e-9);
  EXPECT_NEAR(fix.position->lon, -151.2000001, 1e-9);
  EXPECT_NEAR(*fix.alt_msl_m, 58.312, 1e-9);
  EXPECT_NEAR(*fix.geoid_sep_m, 21.705, 1e-9);
  EXPECT_EQ(fix.satellites, 29);
  EXPECT_NEAR(*fix.sigma_east_m, 0.014 / std::numbers::sqrt2, 1e-9) << "a radius has two axes";
  EXPECT_EQ(fix.sigma_east_m, fix.sigma_north_m);
  EXPECT_EQ(fix.correction_age_s, 2.0) << "the class says 1 to 2 s";
  EXPECT_EQ(base::to_rfc3339(fix.utc.value()), "2026-05-20T11:59:42.000Z");
  const auto velocity = all_of<base::GnssVelocity>(said).at(0);
  EXPECT_NEAR(velocity.north_mps, 1.0, 1e-9);
  EXPECT_NEAR(velocity.east_mps, -0.25, 1e-9);
  EXPECT_NEAR(*velocity.sigma_mps, 0.04, 1e-9);
}

TEST_F(UbxEpochTest, TheMoreExactMessagesOfTheSameEpochImproveIt) {
  hear(ubx::kPvtFixed, t0);
  hear(ubx::kHpPosLlh, t0 + 1ms);
  hear(ubx::kCov, t0 + 2ms);
  epochs.tick(t0 + 1s);
  ASSERT_EQ(fixes().size(), 1u);
  const base::GnssFix fix = fixes()[0];
  EXPECT_NEAR(fix.position->lat, -33.868724293, 1e-10);
  EXPECT_NEAR(fix.position->lon, -151.200000135, 1e-10);
  EXPECT_NEAR(*fix.alt_msl_m, 58.3114, 1e-9);
  EXPECT_NEAR(*fix.sigma_north_m, 0.02, 1e-6) << "root of 4e-4";
  EXPECT_NEAR(*fix.sigma_east_m, 0.03, 1e-6) << "root of 9e-4";
}

TEST_F(UbxEpochTest, AnEpochIsToldWithItsLastMessageOnceTheHabitIsKnown) {
  for (std::uint32_t i = 0; i < 3; ++i) {
    hear_later(ubx::kPvtFixed, i * 200, t0 + i * 200ms);
    hear_later(ubx::kCov, i * 200, t0 + i * 200ms + 1ms);
  }
  EXPECT_EQ(fixes().size(), 3u) << "two with the beginning of the next, the third by habit";
  hear_later(ubx::kPvtFixed, 600, t0 + 600ms);
  EXPECT_EQ(fixes().size(), 3u);
  hear_later(ubx::kCov, 600, t0 + 601ms);
  EXPECT_EQ(fixes().size(), 4u) << "at once: nothing else is to come";
  EXPECT_EQ(fixes().back().stamp, t0 + 600ms);
}

TEST_F(UbxEpochTest, AMessageOfAnotherEpochDoesNotImproveThisOne) {
  hear(ubx::kPvtFixed, t0);
  hear_later(ubx::kHpPosLlh, 200, t0 + 200ms);
  ASSERT_EQ(fixes().size(), 1u);
  EXPECT_NEAR(fixes()[0].position->lat, -33.8687243, 1e-10);
}

TEST_F(UbxEpochTest, WithoutAFixThereIsNoPositionAndNoVelocity) {
  hear(ubx::kPvtNoFix, t0);
  epochs.tick(t0 + 1s);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(fixes().at(0).fix, base::FixType::None);
  EXPECT_EQ(fixes()[0].position, std::nullopt);
  EXPECT_EQ(fixes()[0].sigma_east_m, std::nullopt);
}

TEST_F(UbxEpochTest, AMovingBaseGivesAHeadingTurnedAsItsAntennasAreMounted) {
  hear(ubx::kPvtFixed, t0);
  hear(ubx::kRelPosNed, t0 + 30ms);
  const auto headings = all_of<base::Heading>(said);
  ASSERT_EQ(headings.size(), 1u) << "at once";
  EXPECT_EQ(headings[0].stamp, t0) << "of this epoch";
  EXPECT_EQ(headings[0].source, base::HeadingSource::DualAntenna);
  EXPECT_NEAR(headings[0].yaw_rad, base::yaw_from_heading(277.09018 + 90.0), 1e-9);
}

TEST_F(UbxEpochTest, AHeadingIsNeverSurerThanACentimetreOverItsBaseline) {
  auto relative = std::get<ubx::NavRelPosNed>(message_of(ubx::kRelPosNed));
  relative.heading_sigma_deg = 0.1;
  epochs.add(relative, t0);
  relative.heading_sigma_deg = 2.0;
  epochs.add(relative, t0 + 200ms);
  const auto headings = all_of<base::Heading>(said);
  ASSERT_EQ(headings.size(), 2u);
  EXPECT_NEAR(*headings[0].sigma_rad, 0.01, 1e-9);
  EXPECT_NEAR(*headings[1].sigma_rad, base::rad_from_deg(2.0), 1e-9);
}

TEST_F(UbxEpochTest, ABaselineMeasuredMoreThanFivePercentOffIsRefused) {
  auto relative = std::get<ubx::NavRelPosNed>(message_of(ubx::kRelPosNed));
  const double measured_m = relative.length_m;
  for (const double part : {0.94, 1.06}) {
    options.baseline_m = measured_m / part;
    UbxEpochs off(options, [this](const base::Measurement& m) { said.push_back(m); });
    off.add(relative, t0);
    EXPECT_EQ(off.headings_refused(), 1u) << part;
  }
  options.baseline_m = measured_m / 1.04;
  UbxEpochs near(options, [this](const base::Measurement& m) { said.push_back(m); });
  near.add(relative, t0);
  EXPECT_EQ(near.headings_refused(), 0u);
  EXPECT_EQ(said.size(), 1u);
}

TEST_F(UbxEpochTest, ABaselineOfAnotherLengthGivesNoHeading) {
  options.baseline_m = 1.2;
  UbxEpochs other(options, [this](const base::Measurement& m) { said.push_back(m); });
  other.add(message_of(ubx::kRelPosNed), t0);
  EXPECT_TRUE(said.empty());
  EXPECT_EQ(other.headings_refused(), 1u);
}

TEST_F(UbxEpochTest, OneAntennaHasNoHeadingAndRefusesNone) {
  options.baseline_m = 0.0;
  UbxEpochs other(options, [this](const base::Measurement& m) { said.push_back(m); });
  other.add(message_of(ubx::kRelPosNed), t0);
  EXPECT_TRUE(said.empty());
  EXPECT_EQ(other.headings_refused(), 0u);
}

class BlendTest : public ::testing::Test {
 protected:
  static base::GnssFix fix_at(Time t, double lat) {
    base::GnssFix fix;
    fix.stamp = t;
    fix.fix = base::FixType::RtkFixed;
    fix.position = base::LatLon{lat, 26.0};
    return fix;
  }
  std::vector<base::GnssFix> fixes() const { return all_of<base::GnssFix>(told); }
  std::vector<base::Measurement> told;
  Blend blend{[this](const base::Measurement& m) { told.push_back(m); }};
  Time t0 = Time{} + 100s;
};

TEST_F(BlendTest, UbxSpeaksAndNmeaAddsWhatItLacks) {
  base::GnssFix nmea = fix_at(t0, 58.0);
  nmea.hdop = 0.6;
  nmea.correction_age_s = 1.4;
  blend.nmea(nmea);
  base::GnssFix ubx = fix_at(t0 + 10ms, 58.1);
  ubx.correction_age_s = 2.0;
  blend.ubx(ubx);
  blend.nmea(fix_at(t0 + 200ms, 58.2));
  blend.nmea(base::GnssVelocity{t0 + 200ms, 1.0, 0.0, {}});
  ASSERT_EQ(told.size(), 2u) << "NMEA's first, before UBX was heard, then only UBX";
  EXPECT_EQ(fixes()[1].position->lat, 58.1);
  EXPECT_EQ(fixes()[1].hdop, 0.6);
  EXPECT_EQ(fixes()[1].correction_age_s, 1.4) << "exact, not a class";
}

TEST_F(BlendTest, WhereUbxFallsSilentNmeaGoesOn) {
  blend.ubx(fix_at(t0, 58.1));
  blend.nmea(fix_at(t0 + 1999ms, 58.2));
  EXPECT_EQ(told.size(), 1u);
  blend.nmea(fix_at(t0 + 2s, 58.3));
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(fixes()[1].position->lat, 58.3);
}

TEST_F(BlendTest, ACompassInNmeaStaysWhereUbxGivesNoHeading) {
  blend.ubx(fix_at(t0, 58.1));
  blend.nmea(base::Heading{t0, 1.0, base::HeadingSource::Compass});
  EXPECT_EQ(told.size(), 2u);
  blend.ubx(base::Heading{t0 + 1s, 1.1, base::HeadingSource::DualAntenna});
  blend.nmea(base::Heading{t0 + 1s, 1.2, base::HeadingSource::Compass});
  ASSERT_EQ(told.size(), 3u);
  EXPECT_EQ(std::get<base::Heading>(told[2]).yaw_rad, 1.1);
}

TEST_F(BlendTest, APositionOfZeroZeroIsNone) {
  base::GnssFix fix = fix_at(t0, 0.0);
  fix.position->lon = 0.0;
  blend.nmea(fix);
  EXPECT_EQ(fixes().at(0).fix, base::FixType::None);
  EXPECT_EQ(fixes()[0].position, std::nullopt);
  EXPECT_EQ(blend.counts().zero_positions, 1u);
}

TEST_F(BlendTest, ADateOfNineteenEightyIsNone) {
  base::GnssFix fix = fix_at(t0, 58.0);
  fix.utc = std::chrono::sys_days{std::chrono::year{1980} / 1 / 6};
  blend.ubx(fix);
  EXPECT_EQ(fixes().at(0).utc, std::nullopt);
  EXPECT_TRUE(fixes()[0].position) << "the position may well be right";
  EXPECT_EQ(blend.counts().impossible_dates, 1u);
}

TEST_F(BlendTest, AnEpochBeforeTheLastOneIsNoPosition) {
  const base::WallTime noon = std::chrono::sys_days{std::chrono::year{2026} / 3 / 1} + 12h;
  const auto say = [&](base::Duration after) {
    base::GnssFix fix = fix_at(t0, 58.0);
    fix.utc = noon + after;
    blend.nmea(fix);
  };
  for (const auto after : {0s, 1s, -5s, -4s, -3s}) say(after);
  ASSERT_EQ(fixes().size(), 5u);
  EXPECT_TRUE(fixes()[1].position);
  EXPECT_FALSE(fixes()[2].position);
  EXPECT_EQ(fixes()[2].fix, base::FixType::None);
  EXPECT_TRUE(fixes()[3].position) << "a clock that was set back goes on";
  EXPECT_EQ(blend.counts().backwards, 1u);
}

TEST(CalendarOfEpochs, AYearThatNoClockHoldsIsNoDate) {
  Calendar calendar;
  calendar.set(Date{std::chrono::year{9999} / 12 / 31}, 0.0);
  EXPECT_EQ(calendar.at(0.0), std::nullopt);
  calendar.set(Date{std::chrono::year{2026} / 12 / 31}, 0.0);
  EXPECT_TRUE(calendar.at(0.0));
}

TEST(CorrectionAge, IsTheEndOfItsClass) {
  EXPECT_EQ(correction_age_s(0), std::nullopt);
  EXPECT_EQ(correction_age_s(1), 1.0);
  EXPECT_EQ(correction_age_s(11), 120.0);
  EXPECT_EQ(correction_age_s(15), 600.0);
}

}  // namespace
}  // namespace roverd::gnss
