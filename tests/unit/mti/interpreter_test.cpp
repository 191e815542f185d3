// What an MTi's messages mean for the robot: axes, mounting, lever arm, compass, positions, and
// what of them is not believed.

#include "mti/interpreter.hpp"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "unit/mti/messages.hpp"
#include "unit/mti/words.hpp"

namespace roverd::mti {
namespace {

using base::rad_from_deg;
using namespace std::chrono_literals;

/// An interpreter that is fed by arrival times of its own.
struct Listener {
  explicit Listener(const Params& p = {})
      : interpreter("mti", p,
                    {[this](const base::Measurement& m) { heard.push_back(m); },
                     [this](std::string_view c, std::uint64_t n) { refused[std::string(c)] += n; },
                     [this](std::string_view c, std::uint64_t n) { noted[std::string(c)] += n; }}) {
  }

  bool take(const Data2Builder& b, base::Duration arrival = 0ms) {
    now += 10ms;
    return interpreter.take(b.payload(), base::Time{now + arrival});
  }
  /// The next healthy word, with what `add` puts into it.
  template <class F>
  bool say(F add, Word word = {}) {
    word.count = count += 100;
    word.number = number++;
    Data2Builder b = word.builder();
    add(b);
    return take(b);
  }
  template <class M>
  M last() const {
    const auto all = all_of<M>(heard);
    EXPECT_FALSE(all.empty());
    return all.empty() ? M{} : all.back();
  }

  std::vector<base::Measurement> heard;
  std::map<std::string, std::uint64_t> refused;
  std::map<std::string, std::uint64_t> noted;
  Interpreter interpreter;
  base::Duration now = 100s;
  std::uint32_t count = 5000;
  std::uint16_t number = 7;
};

const auto nothing = [](Data2Builder&) {};

TEST(MtiInterpreter, RateAndAccelerationOfALevelUnitAreTheBodys) {
  Listener l;
  Word w;
  w.rate = {0.01, -0.02, 0.5};
  w.accel = {1.0, -0.5, 9.81};
  ASSERT_TRUE(l.say(nothing, w));
  const auto m = l.last<base::Inertial>();
  ASSERT_TRUE(m.rate_radps && m.accel_mps2);
  EXPECT_NEAR(m.rate_radps->forward, 0.01, 1e-6);
  EXPECT_NEAR(m.rate_radps->left, -0.02, 1e-6);
  EXPECT_NEAR(m.rate_radps->up, 0.5, 1e-6);
  EXPECT_NEAR(m.accel_mps2->forward, 1.0, 1e-6);
  EXPECT_NEAR(m.accel_mps2->up, 9.81, 1e-5);
}

TEST(MtiInterpreter, AMountedUnitIsTurnedIntoTheBody) {
  // Its x axis points left (yaw 90): what it calls x is the body's left, its y is backward.
  Listener yawed({.mount_yaw_deg = 90.0});
  Word w;
  w.accel = {1.0, 2.0, 9.81};
  yawed.say(nothing, w);
  EXPECT_NEAR(yawed.last<base::Inertial>().accel_mps2->left, 1.0, 1e-5);
  EXPECT_NEAR(yawed.last<base::Inertial>().accel_mps2->forward, -2.0, 1e-5);
  // Upside down (roll 180): a turn to the left is one about its own z axis downwards.
  Listener upside_down({.mount_roll_deg = 180.0});
  Word v;
  v.rate = {0.0, 0.0, -0.3};
  v.accel = {0.0, 0.0, -9.81};
  upside_down.say(nothing, v);
  EXPECT_NEAR(upside_down.last<base::Inertial>().rate_radps->up, 0.3, 1e-6);
  EXPECT_NEAR(upside_down.last<base::Inertial>().accel_mps2->up, 9.81, 1e-5);
  // Its x axis points up (pitch 90).
  Listener pitched({.mount_pitch_deg = 90.0});
  Word u;
  u.accel = {9.81, 0.0, 0.0};
  pitched.say(nothing, u);
  EXPECT_NEAR(pitched.last<base::Inertial>().accel_mps2->up, 9.81, 1e-5);
}

TEST(MtiInterpreter, TheLeverArmsCentripetalPartIsTakenOff) {
  // 0.5 m ahead of the centre, turning at 2 rad/s: the unit feels 2 m/s2 towards the centre.
  Listener l({.arm_forward_m = 0.5});
  Word w;
  w.rate = {0.0, 0.0, 2.0};
  w.accel = {-2.0, 0.0, 9.81};
  l.say(nothing, w);
  EXPECT_NEAR(l.last<base::Inertial>().accel_mps2->forward, 0.0, 1e-5);
}

TEST(MtiInterpreter, AttitudeComesOutTheSameFromEveryLocalFrame) {
  const double roll = rad_from_deg(5.0);
  const double pitch = rad_from_deg(-8.0);
  const double yaw = rad_from_deg(30.0);
  const Mat3 R_EB = about_z(yaw) * leaning(roll, pitch);
  for (const Axes axes : {Axes::Enu, Axes::Ned, Axes::Nwu}) {
    Listener l({.heading = "orientation"});
    l.say([&](Data2Builder& b) { with_orientation(b, axes, to_enu(axes).transposed() * R_EB); });
    EXPECT_NEAR(l.last<base::Attitude>().roll_rad, roll, 1e-6) << to_string(axes);
    EXPECT_NEAR(l.last<base::Attitude>().pitch_rad, pitch, 1e-6) << to_string(axes);
    EXPECT_NEAR(l.last<base::Heading>().yaw_rad, yaw, 1e-6) << to_string(axes);
  }
}

TEST(MtiInterpreter, EulerAnglesServeWhereThereIsNoQuaternion) {
  Listener l({.heading = "orientation"});
  l.say([](Data2Builder& b) { b.numbers(xdi_of(Kind::Euler), {4.0, 0.0, 120.0}); });
  EXPECT_NEAR(l.last<base::Attitude>().roll_rad, rad_from_deg(4.0), 1e-6);
  EXPECT_NEAR(l.last<base::Heading>().yaw_rad, rad_from_deg(120.0), 1e-6);
}

TEST(MtiInterpreter, TheMountingIsTakenOffTheAttitude) {
  const Mat3 R_BS = about_z(rad_from_deg(90.0)) * leaning(rad_from_deg(180.0), 0.0);
  const Mat3 R_EB = about_z(0.4) * leaning(0.1, 0.05);
  Listener l({.mount_yaw_deg = 90.0, .mount_roll_deg = 180.0, .heading = "orientation"});
  l.say([&](Data2Builder& b) { with_orientation(b, Axes::Enu, R_EB * R_BS); });
  EXPECT_NEAR(l.last<base::Attitude>().roll_rad, 0.1, 1e-6);
  EXPECT_NEAR(l.last<base::Attitude>().pitch_rad, 0.05, 1e-6);
  EXPECT_NEAR(l.last<base::Heading>().yaw_rad, 0.4, 1e-6);
}

/// The field in the body's axes of a robot that leans, with magnetic heading `deg`.
Vec3 field_at(double deg, double roll_rad, double pitch_rad) {
  const double dip = rad_from_deg(70.0);
  const Vec3 level{std::cos(dip) * std::cos(rad_from_deg(deg)),
                   std::cos(dip) * std::sin(rad_from_deg(deg)), -std::sin(dip)};
  return leaning(roll_rad, pitch_rad).transposed() * level;
}

TEST(MtiInterpreter, TheCompassIsLevelledAndMadeTrue) {
  const double roll = rad_from_deg(6.0);
  const double pitch = rad_from_deg(-4.0);
  const Vec3 f = field_at(100.0, roll, pitch);
  const auto field = [&](Data2Builder& b) {
    b.numbers(xdi_of(Kind::MagneticField), {f[0], f[1], f[2]});
  };
  // By the unit's own attitude:
  Listener oriented({.declination_deg = 10.0});
  oriented.say([&](Data2Builder& b) {
    with_orientation(b, Axes::Enu, about_z(1.0) * leaning(roll, pitch));
    field(b);
  });
  EXPECT_NEAR(base::heading_from_yaw(oriented.last<base::Heading>().yaw_rad), 110.0, 1e-4);
  EXPECT_EQ(oriented.last<base::Heading>().source, base::HeadingSource::Compass);
  // By the acceleration, where it tells none:
  Listener bare;
  Word w;
  w.accel = leaning(roll, pitch).transposed() * Vec3{0.0, 0.0, 9.81};
  bare.say(field, w);
  EXPECT_NEAR(base::heading_from_yaw(bare.last<base::Heading>().yaw_rad), 100.0, 1e-3);
}

TEST(MtiInterpreter, HeadingsAreToldAtTheirRate) {
  Listener l({.heading_hz = 10.0});
  for (int i = 0; i < 100; ++i) {
    l.say([](Data2Builder& b) { b.numbers(xdi_of(Kind::MagneticField), {0.4, 0.0, -0.9}); });
  }
  EXPECT_EQ(all_of<base::Heading>(l.heard).size(), 10u);
  EXPECT_EQ(all_of<base::Inertial>(l.heard).size(), 100u);
}

TEST(MtiInterpreter, AFieldThatIsNotTheEarthsGivesNoHeading) {
  Listener l;
  for (const Vec3& f : {Vec3{3.0, 0.0, -1.0}, Vec3{0.1, 0.0, -0.1}, Vec3{0.01, 0.0, -1.0}}) {
    l.say([&](Data2Builder& b) { b.numbers(xdi_of(Kind::MagneticField), {f[0], f[1], f[2]}); });
  }
  EXPECT_TRUE(all_of<base::Heading>(l.heard).empty());
  EXPECT_EQ(l.refused["magnetic field that is not the earth's"], 3u);
}

TEST(MtiInterpreter, ClippedSensorsAreNotTold) {
  Listener l;
  Word w;
  w.status = kHealthy | 1U << 11U | 1U << 19U;  // gyro x
  l.say(nothing, w);
  EXPECT_FALSE(l.last<base::Inertial>().rate_radps);
  EXPECT_TRUE(l.last<base::Inertial>().accel_mps2);
  EXPECT_EQ(l.refused["rate of turn beyond the gyro's range"], 1u);
}

TEST(MtiInterpreter, AFailedSelfTestRefusesEverything) {
  Listener l;
  Word w;
  w.status = 0x0000'0002;
  EXPECT_FALSE(l.say(nothing, w));
  EXPECT_TRUE(l.heard.empty());
  EXPECT_EQ(l.refused["the unit's self-test failed"], 1u);
}

TEST(MtiInterpreter, AnOrientationThatIsNotValidIsNotTold) {
  Listener l({.heading = "orientation"});
  Word w;
  w.status = 0x0000'0001;
  l.say([](Data2Builder& b) { with_orientation(b, Axes::Enu, Mat3{}); }, w);
  EXPECT_TRUE(all_of<base::Attitude>(l.heard).empty());
  EXPECT_TRUE(all_of<base::Heading>(l.heard).empty());
  EXPECT_EQ(all_of<base::Inertial>(l.heard).size(), 1u);
}

TEST(MtiInterpreter, ATimeThatStandsOrGoesBackIsRefused) {
  Listener l;
  Word w;
  w.count = 1000;
  EXPECT_TRUE(l.take(w.builder()));
  EXPECT_FALSE(l.take(w.builder()));
  EXPECT_TRUE(l.interpreter.frozen());
  w.count = 900;
  EXPECT_FALSE(l.take(w.builder()));
  EXPECT_FALSE(l.interpreter.frozen());
  w.count = 1000;  // it began anew, and goes on from there
  EXPECT_TRUE(l.take(w.builder()));
  EXPECT_EQ(all_of<base::Inertial>(l.heard).size(), 2u);
  EXPECT_EQ(l.refused["sample time standing still"], 1u);
  EXPECT_EQ(l.refused["sample time going back"], 1u);
}

TEST(MtiInterpreter, LostMessagesAreCountedOverTheWrap) {
  Listener l;
  Word w;
  w.number = 65534;
  w.count = 100;
  l.take(w.builder());
  w.number = 1;  // 65535 and 0 did not come
  w.count = 400;
  l.take(w.builder());
  EXPECT_EQ(l.noted["message lost on the way"], 2u);
}

TEST(MtiInterpreter, StampsAreAsEvenAsTheSamples) {
  Listener l;
  Word w;
  const base::Duration late[] = {4ms, 0ms, 9ms, 1ms, 3ms, 0ms};
  for (const base::Duration d : late) {
    w.count += 100;
    ASSERT_TRUE(l.take(w.builder(), d));
  }
  const auto all = all_of<base::Inertial>(l.heard);
  ASSERT_EQ(all.size(), 6u);
  // From the first one on that came without delay:
  for (std::size_t i = 2; i < all.size(); ++i) {
    EXPECT_NEAR(base::seconds(all[i].stamp - all[i - 1].stamp), 0.01, 1e-5);
  }
  EXPECT_NEAR(base::seconds(all[2].stamp.time_since_epoch()), 100.03, 1e-5);
}

TEST(MtiInterpreter, TheFiltersPositionIsToldAtTheBodysOrigin) {
  Listener l({.arm_forward_m = 1.0, .position = "filter", .position_hz = 5.0});
  Word w;
  w.status = kWithFix;
  w.rate = {0.0, 0.0, 0.5};
  for (int i = 0; i < 40; ++i) {
    l.say(
        [](Data2Builder& b) {
          with_orientation(b, Axes::Enu, about_z(0.0));  // facing east
          b.numbers(xdi_of(Kind::LatLon, Axes::Enu, Format::Fp1632), {58.0, 26.0});
          b.numbers(xdi_of(Kind::Velocity, Axes::Ned), {0.5, 2.0, 0.0});
        },
        w);
  }
  const auto fixes = all_of<base::GnssFix>(l.heard);
  ASSERT_EQ(fixes.size(), 2u);  // 0.4 s at 5 Hz
  EXPECT_EQ(fixes[0].fix, base::FixType::Single);
  const auto off = base::distance_bearing(*fixes[0].position, {58.0, 26.0});
  EXPECT_NEAR(off.distance_m, 1.0, 1e-3);
  EXPECT_NEAR(off.bearing_deg, 90.0, 0.1);  // the unit sits a metre east of what is told
  const auto v = l.last<base::GnssVelocity>();
  EXPECT_NEAR(v.east_mps, 2.0, 1e-5);
  EXPECT_NEAR(v.north_mps, 0.0, 1e-5);  // 0.5 rad/s over 1 m is the unit's swing
}

TEST(MtiInterpreter, WithoutAFixTheFilterCoastsAndSaysSo) {
  Listener l({.position = "filter"});
  l.say([](Data2Builder& b) {
    b.numbers(xdi_of(Kind::LatLon, Axes::Enu, Format::Float64), {58.0, 26.0});
  });
  EXPECT_EQ(l.last<base::GnssFix>().fix, base::FixType::Estimated);
}

TEST(MtiInterpreter, ZeroZeroIsNoPosition) {
  Listener l({.position = "filter"});
  l.say([](Data2Builder& b) {
    b.numbers(xdi_of(Kind::LatLon, Axes::Enu, Format::Float64), {0.0, 0.0});
  });
  EXPECT_FALSE(l.last<base::GnssFix>().position);
  EXPECT_EQ(l.last<base::GnssFix>().fix, base::FixType::None);
  EXPECT_EQ(l.refused["position 0, 0"], 1u);
}

TEST(MtiInterpreter, TheReceiverInTheUnitIsHeardOnRequest) {
  const auto bytes = from_hex(kPvt);
  Framer framer;
  Listener l({.position = "gnss"});
  framer.feed(bytes, [&](const Message& m) {
    EXPECT_TRUE(l.interpreter.take(m.payload, base::Time{l.now}));
  });
  const auto fix = l.last<base::GnssFix>();
  EXPECT_EQ(fix.fix, base::FixType::Single);
  EXPECT_NEAR(fix.position->lat, -33.5, 1e-9);
  EXPECT_NEAR(*fix.alt_msl_m, 58.312, 1e-9);
  EXPECT_EQ(*fix.satellites, 18);
  EXPECT_NEAR(l.last<base::GnssVelocity>().north_mps, 1.5, 1e-9);
}

TEST(MtiInterpreter, ItsSatellitesAreTold) {
  Data2Builder b;
  // iTOW, two of them: GPS 5 with 41 dBHz in the solution, GLONASS 77 without a signal.
  std::vector<std::uint8_t> payload{0x70, 0x20, 16, 0, 0, 0, 0, 2, 0, 0, 0};
  for (const int v : {0, 5, 41, 0x0F, 6, 77, 0, 0}) payload.push_back(static_cast<std::uint8_t>(v));
  Listener l;
  ASSERT_TRUE(l.interpreter.take(payload, base::Time{l.now}));
  const auto sky = l.last<base::SatellitesInView>();
  EXPECT_EQ(sky.driver, "mti");
  ASSERT_EQ(sky.satellites->size(), 2u);
  const base::Satellite& gps = sky.satellites->front();
  EXPECT_EQ(gps.system, "gps");
  EXPECT_EQ(gps.number, 5);
  EXPECT_EQ(gps.cn0_dbhz, 41.0);
  EXPECT_EQ(gps.used, true);
  EXPECT_EQ(sky.satellites->back().system, "glonass");
  EXPECT_FALSE(sky.satellites->back().cn0_dbhz);
  EXPECT_EQ(sky.satellites->back().used, false);
}

TEST(MtiInterpreter, DamagedPacketsAreNamedAndUnknownOnesNoted) {
  Listener l;
  l.say([](Data2Builder& b) {
    b.numbers(xdi_of(Kind::MagneticField), {0.4, 0.0});              // two of three
    b.numbers(xdi_of(Kind::Quaternion), {2.0, 0.0, 0.0, 0.0});       // no rotation
    b.numbers(xdi_of(Kind::Euler, Axes::Unknown), {1.0, 2.0, 3.0});  // of which frame?
    b.numbers(xdi_of(Kind::LatLon, Axes::Enu, Format::Float64), {91.0, 0.0});
    b.numbers(xdi_of(Kind::RateOfTurn, Axes::Enu, Format::Float64), {1e300, 0.0, 0.0});
    b.integer(0x0990, 1, 4);
    b.integer(0x8830, 1, 4);
    b.numbers(xdi_of(Kind::Temperature), {20.0});
  });
  EXPECT_EQ(l.refused["magnetic field: the wrong size for this data id"], 1u);
  EXPECT_EQ(l.refused["quaternion: not of length one"], 1u);
  EXPECT_EQ(l.refused["euler: unknown coordinate system"], 1u);
  EXPECT_EQ(l.refused["lat lon: a position that is not on earth"], 1u);
  EXPECT_EQ(l.refused["rate of turn: impossible"], 1u);
  EXPECT_EQ(l.noted["unknown packet"], 1u);
  EXPECT_EQ(l.noted["packet of old GNSS format"], 1u);
  EXPECT_EQ(l.noted["packet of no use"], 1u);
  EXPECT_EQ(l.heard.size(), 1u);  // the inertial part is intact
}

TEST(MtiInterpreter, AMessageThatRunsPastItsEndIsRefusedWhole) {
  Listener l;
  auto payload = Word{}.builder().payload();
  payload.pop_back();
  EXPECT_FALSE(l.interpreter.take(payload, base::Time{l.now}));
  EXPECT_TRUE(l.heard.empty());
  EXPECT_EQ(l.refused["MTData2 with a packet that runs past its end"], 1u);
}

}  // namespace
}  // namespace roverd::mti
