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
  EXPECT_EQ(decode({{0x01, 0x22}, {}}).verdict, Verdict::NotOurs);
  EXPECT_EQ(name_of({0x01, 0x22}), "NAV-CLOCK");
  EXPECT_EQ(name_of({0x7F, 0x7F}), "");
}

TEST(UbxMessages, EveryPayloadShorterThanItsMessageIsTooShort) {
  struct Least {
    std::string_view hex;
    std::size_t bytes;
  };
  for (const Least& least : {Least{kPvtFixed, 84}, Least{kHpPosLlh, 36}, Least{kRelPosNed, 64},
                             Least{kCov, 64}, Least{kAckAck, 2}}) {
    const auto frame = from_hex(least.hex);
    const Frame f = opened(frame);
    for (std::size_t n = 0; n <= f.payload.size(); ++n) {
      const Verdict wanted = n < least.bytes ? Verdict::TooShort : Verdict::Decoded;
      EXPECT_EQ(decode({f.key, f.payload.first(n)}).verdict, wanted) << name_of(f.key) << " " << n;
    }
  }
}

TEST(UbxMessages, AVersionIsReadAsFarAsItsPartsAreWhole) {
  const auto frame = from_hex(kMonVerAnswer);
  const Frame f = opened(frame);
  for (std::size_t n = 1; n <= f.payload.size(); ++n) {
    const Decoded d = decode({f.key, f.payload.first(n)});
    EXPECT_EQ(d.verdict, n < 40 ? Verdict::TooShort : Verdict::Decoded) << n;
    if (n >= 40) {
      EXPECT_EQ(std::get<MonVer>(d.message).extensions.size(), (n - 40) / 30) << n;
    }
  }
}

TEST(UbxMessages, SettingsAreReadItemByWholeItem) {
  const auto frame = from_hex(kValSetPort);  // 4 bytes, an item of 1 and one of 4 bytes
  const Frame f = opened(frame);
  for (std::size_t n = 0; n <= f.payload.size(); ++n) {
    const Decoded d = decode({f.key, f.payload.first(n)});
    const bool whole = n == 4 || n == 9 || n == 17;
    EXPECT_EQ(d.verdict, whole ? Verdict::Decoded : Verdict::TooShort) << n;
    if (whole) {
      EXPECT_EQ(std::get<ValSet>(d.message).items.size(), n == 4 ? 0u : n == 9 ? 1u : 2u) << n;
    }
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

/// Payloads written by their offsets in the interface description.
class Payload {
 public:
  explicit Payload(std::size_t size) : bytes(size, 0) {}
  Payload& put(std::size_t at, std::int64_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      bytes.at(at + i) = static_cast<std::uint8_t>(value >> 8 * i);
    }
    return *this;
  }
  std::vector<std::uint8_t> bytes;
};

Payload relposned_0() {
  Payload p(40);
  p.put(0, 0, 1).put(2, 0x0123, 2).put(4, 302'400'000, 4);
  p.put(8, -60, 4).put(12, 80, 4).put(16, 5, 4);    // cm
  p.put(20, -50, 1).put(21, 99, 1).put(22, -1, 1);  // 0.1 mm
  p.put(24, 100, 4).put(28, 200, 4).put(32, 300, 4);
  p.put(36, 0b11'0111, 4);  // fix, differential, valid, fixed (2 << 3), moving
  return p;
}

TEST(UbxMessages, NavRelPosNedOfVersion0IsReadAndItsHeadingComputed) {
  const Payload p = relposned_0();
  const Decoded d = decode({key::kNavRelPosNed, p.bytes});
  ASSERT_EQ(d.verdict, Verdict::Decoded);
  const auto& m = std::get<NavRelPosNed>(d.message);
  EXPECT_EQ(m.version, 0);
  EXPECT_EQ(m.station, 0x0123);
  EXPECT_EQ(m.itow_ms, 302'400'000u);
  EXPECT_DOUBLE_EQ(m.position_m.north, -0.6050);
  EXPECT_DOUBLE_EQ(m.position_m.east, 0.8099);
  EXPECT_DOUBLE_EQ(m.position_m.down, 0.0499);
  EXPECT_DOUBLE_EQ(m.sigma_m.north, 0.010);
  EXPECT_DOUBLE_EQ(m.sigma_m.east, 0.020);
  EXPECT_DOUBLE_EQ(m.sigma_m.down, 0.030);
  EXPECT_NEAR(m.length_m, 1.0121527, 1e-6);
  EXPECT_NEAR(m.heading_deg, 126.7590, 1e-3);  // south-east: atan2(0.8099, -0.605)
  // Across the line 0.01·sin and 0.02·cos of its direction, 14.4 mm over 1.011 m:
  EXPECT_NEAR(m.heading_sigma_deg, 0.8172, 2e-3);
  EXPECT_EQ(m.carrier(), Carrier::Fixed);
  EXPECT_TRUE(m.fix_ok() && m.differential() && m.position_valid() && m.moving());
  EXPECT_TRUE(m.heading_valid());
  EXPECT_FALSE(m.normalised());
  EXPECT_TRUE(m.heading_usable(1.0, 0.05));
  EXPECT_FALSE(m.heading_usable(1.2, 0.05));
}

TEST(UbxMessages, NavRelPosNedOfVersion0IsNoHeadingOfAFixedBaseNorOfNoLength) {
  Payload fixed_base = relposned_0();
  fixed_base.put(36, 0b01'0111, 4);
  const Decoded d = decode({key::kNavRelPosNed, fixed_base.bytes});
  EXPECT_FALSE(std::get<NavRelPosNed>(d.message).heading_valid());
  Payload nowhere = relposned_0();
  nowhere.put(8, 0, 4).put(12, 0, 4).put(20, 0, 1).put(21, 0, 1);
  const Decoded n = decode({key::kNavRelPosNed, nowhere.bytes});
  EXPECT_FALSE(std::get<NavRelPosNed>(n.message).heading_valid());
  EXPECT_DOUBLE_EQ(std::get<NavRelPosNed>(n.message).length_m, 0.0499);
  // Bits that later versions use mean nothing here.
  Payload later = relposned_0();
  later.put(36, 0x300 | 0b01'0111, 4);
  const Decoded l = decode({key::kNavRelPosNed, later.bytes});
  EXPECT_FALSE(std::get<NavRelPosNed>(l.message).heading_valid());
  EXPECT_FALSE(std::get<NavRelPosNed>(l.message).normalised());
}

TEST(UbxMessages, NavRelPosNedNeedsTheBytesOfItsVersion) {
  Payload p = relposned_0();
  EXPECT_EQ(decode({key::kNavRelPosNed, Bytes(p.bytes).first(39)}).verdict, Verdict::TooShort);
  p.put(0, 1, 1);
  EXPECT_EQ(decode({key::kNavRelPosNed, p.bytes}).verdict, Verdict::TooShort);
  p.put(0, 2, 1);
  EXPECT_EQ(decode({key::kNavRelPosNed, p.bytes}).verdict, Verdict::WrongVersion);
  EXPECT_EQ(decode({key::kNavRelPosNed, {}}).verdict, Verdict::TooShort);
}

TEST(UbxMessages, NavSigGivesEachSignalWithItsUse) {
  Payload p(8 + 16 * 3);
  p.put(0, 302'400'000, 4).put(4, 0, 1).put(5, 3, 1);
  // GPS 5 L1 C/A: 45 dBHz, code, carrier and Doppler used, healthy
  p.put(8, 0, 1)
      .put(9, 5, 1)
      .put(10, 0, 1)
      .put(12, -25, 2)
      .put(14, 45, 1)
      .put(15, 7, 1)
      .put(18, 0x39, 2);
  // Galileo 11 E5b Q: 38 dBHz, only tracked, unhealthy
  p.put(24, 2, 1)
      .put(25, 11, 1)
      .put(26, 6, 1)
      .put(28, 32767, 2)
      .put(30, 38, 1)
      .put(31, 4, 1)
      .put(34, 0x02, 2);
  // one of a system to come
  p.put(40, 9, 1).put(41, 200, 1).put(42, 77, 1).put(50, 0xFFFF, 2);
  const Decoded d = decode({key::kNavSig, p.bytes});
  ASSERT_EQ(d.verdict, Verdict::Decoded);
  const auto& m = std::get<NavSig>(d.message);
  EXPECT_EQ(m.itow_ms, 302'400'000u);
  ASSERT_EQ(m.all.size(), 3u);
  EXPECT_EQ(m.all[0].gnss_id, 0);
  EXPECT_EQ(m.all[0].number, 5);
  EXPECT_EQ(m.all[0].cn0_dbhz, 45);
  EXPECT_EQ(m.all[0].quality, 7);
  EXPECT_EQ(m.all[0].health(), 1);
  EXPECT_DOUBLE_EQ(m.all[0].residual_m, -2.5);
  EXPECT_TRUE(m.all[0].code_used() && m.all[0].carrier_used() && m.all[0].doppler_used());
  EXPECT_TRUE(m.all[0].used());
  EXPECT_EQ(signal_name(0, m.all[0].signal_id), "L1 C/A");
  EXPECT_EQ(m.all[1].gnss_id, 2);
  EXPECT_EQ(m.all[1].number, 11);
  EXPECT_EQ(m.all[1].health(), 2);
  EXPECT_FALSE(m.all[1].code_used() || m.all[1].carrier_used() || m.all[1].doppler_used());
  EXPECT_FALSE(m.all[1].used());
  EXPECT_DOUBLE_EQ(m.all[1].residual_m, 3276.7);
  EXPECT_EQ(signal_name(2, m.all[1].signal_id), "E5b Q");
  EXPECT_EQ(signal_name(9, m.all[2].signal_id), "");
  EXPECT_EQ(signal_name(6, 2), "L2 OF");
}

TEST(UbxMessages, EachWayASignalIsUsedCountsByItself) {
  for (const unsigned bit : {3u, 4u, 5u}) {
    Payload p(8 + 16);
    p.put(5, 1, 1).put(18, 1 << bit, 2);
    const Decoded d = decode({key::kNavSig, p.bytes});
    const auto& one = std::get<NavSig>(d.message).all.at(0);
    EXPECT_TRUE(one.used()) << bit;
    EXPECT_EQ(one.code_used(), bit == 3);
    EXPECT_EQ(one.carrier_used(), bit == 4);
    EXPECT_EQ(one.doppler_used(), bit == 5);
  }
  Payload smoothed(8 + 16);
  smoothed.put(5, 1, 1).put(18, 0xFFC7, 2);  // all but those three
  EXPECT_FALSE(std::get<NavSig>(decode({key::kNavSig, smoothed.bytes}).message).all.at(0).used());
}

TEST(UbxMessages, NavSigThatIsCutOrOfAnotherVersionIsRefused) {
  Payload p(8 + 16 * 2);
  p.put(5, 2, 1);
  EXPECT_EQ(decode({key::kNavSig, p.bytes}).verdict, Verdict::Decoded);
  EXPECT_EQ(decode({key::kNavSig, Bytes(p.bytes).first(39)}).verdict, Verdict::TooShort);
  EXPECT_EQ(decode({key::kNavSig, Bytes(p.bytes).first(7)}).verdict, Verdict::TooShort);
  p.put(4, 1, 1);
  EXPECT_EQ(decode({key::kNavSig, p.bytes}).verdict, Verdict::WrongVersion);
  Payload none(8);
  const Decoded d = decode({key::kNavSig, none.bytes});
  EXPECT_TRUE(std::get<NavSig>(d.message).all.empty());
}

}  // namespace
}  // namespace roverd::ubx
