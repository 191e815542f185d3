// The fact sheet's vectors, and what must not be believed.

#include "ubx/messages.hpp"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "frames.hpp"

namespace roverd::ubx {
namespace {

template <class M>
M message(std::string_view hex) {
  const auto frame = from_hex(hex);
  EXPECT_TRUE(is_intact(frame));
  const Decoded d = decode(opened(frame));
  EXPECT_EQ(d.verdict, Verdict::Decoded);
  const M* m = std::get_if<M>(&d.message);
  EXPECT_NE(m, nullptr);
  return m != nullptr ? *m : M{};
}

TEST(UbxMessages, NavPvtWithAFixedSolution) {
  const auto m = message<NavPvt>(kPvtFixed);
  EXPECT_EQ(m.itow_ms, 302400000U);
  EXPECT_EQ(m.year, 2026);
  EXPECT_EQ(m.month, 5);
  EXPECT_EQ(m.day, 20);
  EXPECT_EQ(m.hour, 11);
  EXPECT_EQ(m.min, 59);
  EXPECT_EQ(m.sec, 42);
  EXPECT_EQ(m.nano, -124);
  EXPECT_TRUE(m.date_valid() && m.time_valid() && m.time_resolved());
  EXPECT_EQ(m.fix_type, 3);
  EXPECT_TRUE(m.fix_ok() && m.differential() && m.usable());
  EXPECT_EQ(m.carrier(), Carrier::Fixed);
  EXPECT_EQ(m.quality(), 4);
  EXPECT_EQ(m.satellites, 29);
  EXPECT_NEAR(m.at.lon, -151.2000001, 1e-9);
  EXPECT_NEAR(m.at.lat, -33.8687243, 1e-9);
  EXPECT_DOUBLE_EQ(m.height_ellipsoid_m, 80.017);
  EXPECT_DOUBLE_EQ(m.height_msl_m, 58.312);
  EXPECT_DOUBLE_EQ(m.horizontal_sigma_m, 0.014);
  EXPECT_DOUBLE_EQ(m.vertical_sigma_m, 0.020);
  EXPECT_DOUBLE_EQ(m.velocity_mps.north, 1.0);
  EXPECT_DOUBLE_EQ(m.velocity_mps.east, -0.25);
  EXPECT_DOUBLE_EQ(m.velocity_mps.down, 0.012);
  EXPECT_DOUBLE_EQ(m.ground_speed_mps, 1.031);
  EXPECT_NEAR(m.course_deg, 345.96375, 1e-9);
  EXPECT_DOUBLE_EQ(m.speed_sigma_mps, 0.040);
  EXPECT_NEAR(m.course_sigma_deg, 1.23456, 1e-9);
  EXPECT_DOUBLE_EQ(m.pdop, 0.98);
  EXPECT_EQ(m.correction_age_class(), 2);
  EXPECT_FALSE(m.heading_deg);
}

TEST(UbxMessages, NavPvtWithoutAFixIsNotUsable) {
  const auto m = message<NavPvt>(kPvtNoFix);
  EXPECT_FALSE(m.usable());
  EXPECT_EQ(m.quality(), 0);
  EXPECT_FALSE(m.time_valid());
  EXPECT_DOUBLE_EQ(m.horizontal_sigma_m, 4294967.295);
  EXPECT_DOUBLE_EQ(m.pdop, 99.99);
}

TEST(UbxMessages, TheOldShortNavPvtIsAcceptedAndAShorterOneIsNot) {
  const auto whole = from_hex(kPvtFixed);
  const Frame f = opened(whole);
  EXPECT_EQ(decode({f.key, f.payload.first(84)}).verdict, Verdict::Decoded);
  EXPECT_EQ(decode({f.key, f.payload.first(83)}).verdict, Verdict::TooShort);
}

TEST(UbxMessages, APositionThatIsNotOnEarthIsRefused) {
  auto bytes = from_hex(kPvtFixed);
  bytes[6 + 31] = 0x7F;  // latitude beyond 90 degrees
  EXPECT_EQ(decode(opened(bytes)).verdict, Verdict::BadValue);
}

TEST(UbxMessages, NavHpPosLlhAddsTheFineParts) {
  const auto m = message<NavHpPosLlh>(kHpPosLlh);
  EXPECT_FALSE(m.invalid);
  EXPECT_NEAR(m.at.lon, -151.200000135, 1e-12);
  EXPECT_NEAR(m.at.lat, -33.868724293, 1e-12);
  EXPECT_NEAR(m.height_ellipsoid_m, 80.0174, 1e-9);
  EXPECT_NEAR(m.height_msl_m, 58.3114, 1e-9);
  EXPECT_NEAR(m.horizontal_sigma_m, 0.0138, 1e-9);
  EXPECT_NEAR(m.vertical_sigma_m, 0.0199, 1e-9);
}

TEST(UbxMessages, NavRelPosNedGivesAHeadingIfTheLengthIsTheMountedOne) {
  const auto m = message<NavRelPosNed>(kRelPosNed);
  EXPECT_NEAR(m.position_m.north, 0.1234, 1e-9);
  EXPECT_NEAR(m.position_m.east, -0.9921, 1e-9);
  EXPECT_NEAR(m.position_m.down, -0.0095, 1e-9);
  EXPECT_NEAR(m.length_m, 0.9998, 1e-9);
  EXPECT_NEAR(m.heading_deg, 277.09018, 1e-9);
  EXPECT_NEAR(m.sigma_m.north, 0.0021, 1e-9);
  EXPECT_NEAR(m.sigma_m.east, 0.0022, 1e-9);
  EXPECT_NEAR(m.sigma_m.down, 0.0043, 1e-9);
  EXPECT_NEAR(m.length_sigma_m, 0.0030, 1e-9);
  EXPECT_NEAR(m.heading_sigma_deg, 0.94, 1e-9);
  EXPECT_EQ(m.flags, 0x137U);
  EXPECT_EQ(m.carrier(), Carrier::Fixed);
  EXPECT_TRUE(m.moving());
  EXPECT_TRUE(m.heading_usable(1.0, 0.05));
  EXPECT_FALSE(m.heading_usable(1.2, 0.05)) << "another pair of antennas";
  NavRelPosNed normalised = m;
  normalised.flags |= 1U << 9U;
  EXPECT_FALSE(normalised.heading_usable(1.0, 0.05));
}

TEST(UbxMessages, NavRelPosNedOfVersionZeroIsNotMistaken) {
  const auto old = std::vector<std::uint8_t>(40);
  EXPECT_EQ(decode({key::kNavRelPosNed, old}).verdict, Verdict::WrongVersion);
}

TEST(UbxMessages, NavCovTellsOnlyWhatIsValid) {
  const auto m = message<NavCov>(kCov);
  ASSERT_TRUE(m.position_m2);
  const Covariance wanted{4e-4, 0.0, -1e-4, 9e-4, 2.5e-4, 1.6e-3};
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_NEAR((*m.position_m2)[i], wanted[i], 1e-9) << i;
  }
  EXPECT_FALSE(m.velocity_m2ps2);
}

TEST(UbxMessages, MonVerNamesTheReceiver) {
  const auto m = message<MonVer>(kMonVerAnswer);
  EXPECT_EQ(m.software, "EXT CORE 1.00 (a1b2c3)");
  EXPECT_EQ(m.hardware, "00190000");
  EXPECT_EQ(m.extensions.size(), 4U);
  EXPECT_EQ(m.extension("MOD"), "ZED-F9P");
  EXPECT_EQ(m.extension("PROTVER"), "27.31");
  EXPECT_EQ(m.extension("NONE"), "");
  EXPECT_EQ(message<Poll>(kMonVerPoll).of, key::kMonVer);
}

TEST(UbxMessages, AnswersSayWhichCommandTheyAnswer) {
  EXPECT_TRUE(message<Ack>(kAckAck).accepted);
  EXPECT_FALSE(message<Ack>(kAckNak).accepted);
  EXPECT_EQ(message<Ack>(kAckNak).to, key::kCfgValSet);
}

TEST(UbxMessages, SettingsAreWrittenAsTheSheetSays) {
  ValSet messages{1, {}};
  for (const std::uint32_t id : {0x20910007U, 0x20910034U, 0x2091008EU, 0x20910084U}) {
    messages.items.push_back({id, 1});
  }
  messages.items.push_back({0x30210001, 200});
  messages.items.push_back({0x30210002, 1});
  EXPECT_EQ(encode(messages), from_hex(kValSetMessages));
  const ValSet port{7, {{0x10730004, 1}, {0x40520001, 460800}}};
  EXPECT_EQ(encode(port), from_hex(kValSetPort));
  EXPECT_EQ(message<ValSet>(kValSetPort).items, port.items);
  EXPECT_TRUE(encode(ValSet{1, {{0x00000001, 1}}}).empty()) << "no such size";
}

TEST(UbxMessages, OthersAreNamedAtLeast) {
  EXPECT_EQ(decode({{0x01, 0x43}, {}}).verdict, Verdict::NotOurs);
  EXPECT_EQ(name_of({0x01, 0x43}), "NAV-SIG");
  EXPECT_EQ(name_of({0x7F, 0x7F}), "");
}

TEST(UbxMessages, EveryShorterPayloadIsRefusedOrHarmless) {
  for (const auto hex :
       {kPvtFixed, kHpPosLlh, kRelPosNed, kCov, kMonVerAnswer, kAckAck, kValSetPort}) {
    const auto frame = from_hex(hex);
    const Frame f = opened(frame);
    for (std::size_t n = 0; n < f.payload.size(); ++n) decode({f.key, f.payload.first(n)});
  }
}

TEST(UbxMessages, SatellitesAreReadWholeOrNotAtAll) {
  std::vector<std::uint8_t> payload(8 + 2 * 12, 0);
  payload[4] = 1;
  payload[5] = 2;
  const std::array<std::uint8_t, 12> galileo{2, 11, 41, 50, 0xC8, 0, 0, 0, 0x0F, 0, 0, 0};
  const std::array<std::uint8_t, 12> glonass{6, 255, 0, 0xA5, 0, 0, 0, 0, 1, 0, 0, 0};
  std::copy(galileo.begin(), galileo.end(), payload.begin() + 8);
  std::copy(glonass.begin(), glonass.end(), payload.begin() + 20);
  const Decoded whole = decode({key::kNavSat, payload});
  ASSERT_EQ(whole.verdict, Verdict::Decoded);
  const auto& all = std::get<NavSat>(whole.message).all;
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].azimuth_deg, 200);
  EXPECT_TRUE(all[0].used());
  EXPECT_EQ(all[0].quality(), 7);
  EXPECT_EQ(all[1].elevation_deg, -91);
  payload.pop_back();
  EXPECT_EQ(decode({key::kNavSat, payload}).verdict, Verdict::TooShort);
  payload[4] = 2;
  EXPECT_EQ(decode({key::kNavSat, payload}).verdict, Verdict::WrongVersion);
}

}  // namespace
}  // namespace roverd::ubx
