// The fact sheet's MTData2 messages in all four number formats, and broken ones.

#include "mti/data2.hpp"

#include <gtest/gtest.h>

#include "messages.hpp"

namespace roverd::mti {
namespace {

/// Keeps the bytes that the packets look at.
struct Read {
  explicit Read(std::string_view hex) : bytes(from_hex(hex)) {
    Framer framer;
    framer.feed(bytes, [this](const Message& m) {
      payload.assign(m.payload.begin(), m.payload.end());
      data = decode_data2(payload);
    });
  }
  const Packet* find(Kind kind) const {
    for (const Packet& p : data.packets) {
      if (p.kind() == kind && p.fault == Fault::None) return &p;
    }
    return nullptr;
  }
  template <class T>
  T value(Kind kind) const {
    const Packet* p = find(kind);
    EXPECT_NE(p, nullptr);
    const T* v = p == nullptr ? nullptr : std::get_if<T>(&p->value);
    return v == nullptr ? T{} : *v;
  }
  void expect(Kind kind, std::initializer_list<double> wanted, double tolerance = 1e-12) const {
    const auto n = value<Numbers>(kind);
    ASSERT_EQ(n.size, wanted.size());
    std::size_t i = 0;
    for (const double w : wanted) EXPECT_NEAR(n[i++], w, tolerance);
  }
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint8_t> payload;
  Data2 data;
};

TEST(MtData2, CounterTimeQuaternionAndStatus) {
  const Read r(kQuaternion);
  EXPECT_TRUE(r.data.whole);
  EXPECT_EQ(r.value<std::uint32_t>(Kind::PacketCounter), 513U);
  EXPECT_EQ(r.value<std::uint32_t>(Kind::SampleTimeFine), 1234567U);
  r.expect(Kind::Quaternion, {0.5, -0.5, 0.5, -0.5});
  EXPECT_EQ(r.find(Kind::Quaternion)->axes(), Axes::Enu);
  const auto status = r.value<Status>(Kind::StatusWord);
  EXPECT_EQ(status.word, 0x01800007U);
  EXPECT_TRUE(status.self_test_ok() && status.orientation_valid() && status.gnss_fix());
  EXPECT_FALSE(status.clipping());
  EXPECT_EQ(status.filter_mode(), 3);
}

TEST(MtData2, EulerInFixedPoint1220) {
  const Read r(kEuler);
  r.expect(Kind::Euler, {-1.5, 2.25, 179.75});
  EXPECT_EQ(r.find(Kind::Euler)->axes(), Axes::Ned);
  EXPECT_EQ(r.find(Kind::Euler)->format(), Format::Fp1220);
}

TEST(MtData2, PositionInFixedPoint1632) {
  const Read r(kPosition);
  r.expect(Kind::LatLon, {-33.5, 151.25});
  r.expect(Kind::AltitudeEllipsoid, {80.0625});
  r.expect(Kind::Velocity, {1.5, -0.25, 0.125});
  EXPECT_EQ(r.find(Kind::Velocity)->axes(), Axes::Ned);
}

TEST(MtData2, SpotChecksOfFixedPoint1632) {
  const auto value = [](std::string_view hex) {
    auto payload = from_hex("502206");
    const auto number = from_hex(hex);
    payload.insert(payload.end(), number.begin(), number.end());
    const Data2 d = decode_data2(payload);
    return std::get<Numbers>(d.packets.at(0).value)[0];
  };
  EXPECT_NEAR(value("adf052980039"), 57.679448282346, 1e-12);
  EXPECT_NEAR(value("f63fcaf0ffff"), -0.038089100271, 1e-12);
}

TEST(MtData2, InertialDataInDoubles) {
  const Read r(kAcceleration);
  r.expect(Kind::Acceleration, {0.1, -0.2, 9.81});
  r.expect(Kind::RateOfTurn, {0.001, 0.002, -0.003});
}

TEST(MtData2, TimeOfDayAndMagneticField) {
  const Read r(kUtc);
  const auto utc = r.value<Utc>(Kind::UtcTime);
  EXPECT_EQ(utc.year, 2026);
  EXPECT_EQ(utc.month, 5);
  EXPECT_EQ(utc.day, 20);
  EXPECT_EQ(utc.hour, 11);
  EXPECT_EQ(utc.minute, 59);
  EXPECT_EQ(utc.second, 42);
  EXPECT_EQ(utc.nanosecond, 250'000'000U);
  EXPECT_EQ(utc.flags, 0x37);
  EXPECT_TRUE(utc.date_valid() && utc.time_valid() && utc.resolved());
  r.expect(Kind::MagneticField, {0.25, -0.5, 0.75});
}

TEST(MtData2, GnssPvt) {
  const auto m = Read(kPvt).value<GnssPvt>(Kind::GnssPvt);
  EXPECT_EQ(m.itow_ms, 302400000U);
  EXPECT_EQ(m.utc.second, 42);
  EXPECT_EQ(m.nano, -1000);
  EXPECT_EQ(m.fix_type, 3);
  EXPECT_TRUE(m.usable());
  EXPECT_EQ(m.satellites, 18);
  EXPECT_NEAR(m.at.lon, 151.25, 1e-9);
  EXPECT_NEAR(m.at.lat, -33.5, 1e-9);
  EXPECT_DOUBLE_EQ(m.height_ellipsoid_m, 80.063);
  EXPECT_DOUBLE_EQ(m.height_msl_m, 58.312);
  EXPECT_DOUBLE_EQ(m.horizontal_sigma_m, 1.2);
  EXPECT_DOUBLE_EQ(m.vertical_sigma_m, 1.9);
  EXPECT_DOUBLE_EQ(m.north_mps, 1.5);
  EXPECT_DOUBLE_EQ(m.east_mps, -0.25);
  EXPECT_DOUBLE_EQ(m.down_mps, 0.125);
  EXPECT_DOUBLE_EQ(m.ground_speed_mps, 1.521);
  EXPECT_NEAR(m.course_deg, 350.53782, 1e-9);
  const std::array<double, 7> dop{1.50, 1.30, 0.70, 1.10, 0.80, 0.55, 0.60};
  EXPECT_EQ(m.dop, dop);
}

TEST(MtData2, FourRotationMatricesInOneExtendedMessage) {
  const Read r(kFourMatrices);
  EXPECT_EQ(r.data.packets.size(), 4U);
  r.expect(Kind::RotationMatrix, {1, 0, 0, 0, 1, 0, 0, 0, 1});
}

TEST(MtData2, TheExtendedFormOfAShortMessage) {
  Read(kShortExtended).expect(Kind::AltitudeEllipsoid, {12.5});
}

TEST(MtData2, APacketBeyondTheEndSpoilsTheMessage) {
  const Read r(kWrongInnerSize);
  EXPECT_FALSE(r.data.whole);
  EXPECT_TRUE(r.data.packets.empty());
}

TEST(MtData2, UnknownOldAndMisshapenPacketsSayWhat) {
  const auto payload = from_hex(
      "99900101"
      "88300100"
      "102003000102"
      "5020047fc00000"
      "5040084600000000000000"
      "10200200ff");
  const Data2 d = decode_data2(payload);
  ASSERT_EQ(d.packets.size(), 6U);
  EXPECT_EQ(d.packets[0].fault, Fault::UnknownKind);
  EXPECT_EQ(d.packets[1].fault, Fault::OldGnss);
  EXPECT_EQ(d.packets[2].fault, Fault::WrongSize);
  EXPECT_EQ(d.packets[3].fault, Fault::NotFinite);
  EXPECT_EQ(d.packets[4].fault, Fault::OutOfRange);
  EXPECT_EQ(std::get<std::uint32_t>(d.packets[5].value), 255U) << "the rest is read";
}

TEST(MtData2, ACutIsWholeOnlyBetweenTwoPackets) {
  for (const auto hex : {kQuaternion, kPosition, kPvt, kUtc, kAcceleration}) {
    const Read r(hex);
    std::size_t boundary = 0;  // two bytes of id, one of size, and so many
    std::size_t packets = 0;
    for (std::size_t n = 0; n <= r.payload.size(); ++n) {
      if (n > boundary) {
        const bool fits = n >= boundary + 3 && n == boundary + 3 + r.payload[boundary + 2];
        if (fits) {
          boundary = n;
          ++packets;
        }
      }
      const Data2 d = decode_data2(Bytes(r.payload).first(n));
      EXPECT_EQ(d.whole, n == boundary) << n;
      EXPECT_EQ(d.packets.size(), n == boundary ? packets : 0u) << n;
    }
    EXPECT_EQ(boundary, r.payload.size());
    EXPECT_GT(packets, 0u);
  }
}

}  // namespace
}  // namespace roverd::mti
