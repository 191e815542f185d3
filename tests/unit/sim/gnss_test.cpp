// What the receiver and the compass say, against the truth.

#include <gtest/gtest.h>

#include "plant.hpp"
#include "sim/receiver.hpp"

namespace roverd::sim {
namespace {

base::EnuPoint local(const Plant& plant, const std::string& gga) {
  return plant.bunker.frame().to_local(position(gga));
}

TEST(Gnss, SpeaksFiveSentencesAnEpochAfterTheLatency) {
  Plant plant;
  plant.wait(1s);
  // Epochs at 0.2, 0.4, 0.6, 0.8 s; the one of 1.0 s is still on its way.
  for (const char* kind : {"GGA", "RMC", "VTG", "GST", "HDT"}) {
    EXPECT_EQ(plant.lines(kind).size(), 4u) << kind;
  }
  EXPECT_EQ(plant.gnss_times.front() - Time{}, 320ms);
  EXPECT_EQ(split(plant.lines("GGA").front()).at(1), "120000.20");
  EXPECT_EQ(split(plant.lines("RMC").front()).at(9), "010326");
}

TEST(Gnss, TheRateIsSettable) {
  for (const int rate : {1, 3, 10}) {
    Params p = ideal();
    p.gnss.rate_hz = rate;
    p.gnss.latency_s = 0.0;
    Plant plant(p);
    plant.wait(10s);
    EXPECT_NEAR(static_cast<double>(plant.lines("GGA").size()), rate * 10.0, 1.0) << rate;
  }
}

TEST(Gnss, EpochsLieOnTheUtcSecondWhenTheStartDoesNot) {
  Start start = facing_east();
  start.wall += 37ms;
  Plant plant(ideal(), 1, start);
  plant.wait(1s);
  EXPECT_EQ(split(plant.lines("GGA").front()).at(1), "120000.20");
  EXPECT_EQ(plant.gnss_times.front() - Time{}, 285ms);  // 163 ms + 120 ms, up to the next step
}

TEST(Gnss, SentencesAreExactWithoutNoise) {
  Plant plant;
  plant.wait(400ms);
  EXPECT_EQ(plant.lines("GGA").front(),
            "$GNGGA,120000.20,5822.6812000,N,02643.7340000,E,4,24,0.6,62.000,M,18.400,M,1.0,0001"
            "*62");
  EXPECT_EQ(plant.lines("VTG").front().substr(0, 31), "$GNVTG,,T,,M,0.000,N,0.000,K,R*");
  EXPECT_EQ(plant.lines("HDT").front().substr(0, 14), "$GNHDT,90.00,T");
}

TEST(Gnss, SouthAndWestAndRoundingUpToAWholeDegree) {
  Epoch e;
  e.errors = errors_of(base::FixType::Single);
  e.position = base::LatLon{-33.9999999999, -151.212757201667};
  const auto gga = split(sentences(e).substr(0, sentences(e).find("\r\n")));
  EXPECT_EQ(gga.at(2) + gga.at(3), "3400.0000000S");
  EXPECT_EQ(gga.at(4) + gga.at(5), "15112.7654321W");
  EXPECT_EQ(gga.at(6), "1");
  EXPECT_EQ(gga.at(13), "");
}

TEST(Gnss, AHeadingJustBelowNorthIsNotThreeHundredAndSixty) {
  Epoch e;
  e.heading_deg = 359.999;
  EXPECT_NE(sentences(e).find("$GNHDT,0.00,T*"), std::string::npos);
}

TEST(Gnss, PositionIsWhereTheAntennaWasAtTheEpoch) {
  Params p = ideal();
  p.gnss.antenna_forward_m = 0.3;
  p.gnss.antenna_left_m = 0.1;
  p.gnss.latency_s = 0.1;
  Plant plant(p);
  plant.enter_can();
  plant.drive(1.0, 0.0, 5s);  // now 5.005 s: the epoch of 4.8 s is the last one heard
  const auto seen = local(plant, plant.lines("GGA").back());
  const Truth t = plant.truth();
  EXPECT_EQ(split(plant.lines("GGA").back()).at(1), "120004.80");
  EXPECT_NEAR(seen.east_m, t.local.east_m + 0.3 - 0.205, 0.002);
  EXPECT_NEAR(seen.north_m, 0.1, 0.002);
}

TEST(Gnss, CourseAndSpeedFollowTheMotionBackwardsToo) {
  Plant plant;
  plant.enter_can();
  plant.drive(-1.0, 0.0, 4s);
  const auto vtg = split(plant.lines("VTG").back());
  EXPECT_EQ(vtg.at(1), "270.00");
  EXPECT_NEAR(std::stod(vtg.at(5)), 1.0 / 0.514444, 0.01);
  EXPECT_EQ(split(plant.lines("HDT").back()).at(1), "90.00");
}

TEST(Gnss, RtkNoiseHasTheStatedSizeAndGstSaysSo) {
  Params p = ideal();
  p.gnss.noise_scale = 1.0;
  p.gnss.rate_hz = 10.0;
  Plant plant(p, 3);
  plant.wait(1000s);
  double sum = 0.0;
  double mean = 0.0;
  const auto lines = plant.lines("GGA");
  for (const auto& line : lines) {
    const double east = local(plant, line).east_m;
    sum += east * east;
    mean += east;
  }
  const double n = static_cast<double>(lines.size());
  EXPECT_NEAR(std::sqrt(sum / n), 0.014, 0.003);
  EXPECT_NEAR(mean / n, 0.0, 0.006);
  EXPECT_EQ(split(plant.lines("GST").front()).at(6), "0.014");
}

TEST(Gnss, ConsumerErrorsDriftWithinAMinuteRatherThanJump) {
  Params p = ideal();
  p.gnss.noise_scale = 1.0;
  p.gnss.profile = "consumer";
  p.gnss.rate_hz = 1.0;
  Plant plant(p, 5);
  plant.wait(6000s);
  const auto lines = plant.lines("GGA");
  double sum = 0.0;
  double steps = 0.0;
  double before = local(plant, lines.front()).east_m;
  for (const auto& line : lines) {
    const double east = local(plant, line).east_m;
    sum += east * east;
    steps += (east - before) * (east - before);
    before = east;
  }
  const double n = static_cast<double>(lines.size());
  EXPECT_NEAR(std::sqrt(sum / n), 0.8, 0.2);
  // one second apart: white 0.1·√2 and drift 0.8·√(2/60)
  EXPECT_NEAR(std::sqrt(steps / n), std::hypot(0.1 * 1.414, 0.8 * 0.1826), 0.03);
  EXPECT_EQ(split(lines.back()).at(6), "1");
}

TEST(Gnss, TheCompassHasItsBiasItsNoiseAndAKickFromTheMotors) {
  Params p = ideal();
  p.compass.bias_deg = 8.0;
  p.compass.noise_deg = 1.5;
  Plant plant(p, 9);
  plant.wait(400s);
  double mean = 0.0;
  double sum = 0.0;
  const auto lines = plant.lines("HDT");
  for (const auto& line : lines) {
    const double error = std::stod(split(line).at(1)) - 90.0;
    mean += error;
    sum += (error - 8.0) * (error - 8.0);
  }
  const double n = static_cast<double>(lines.size());
  EXPECT_NEAR(mean / n, 8.0, 0.15);
  EXPECT_NEAR(std::sqrt(sum / n), 1.5, 0.1);

  p = ideal();
  p.compass.kick_deg_per_a = 0.25;
  Plant turning(p);
  turning.enter_can();
  turning.drive(0.0, 0.8, 6s);
  const double truth_deg = base::heading_from_yaw(turning.truth().yaw_rad);
  const double age_deg = base::deg_from_rad(0.8) * 0.205;  // the last epoch heard
  const double shown = std::stod(split(turning.lines("HDT").back()).at(1));
  const double error = base::deg_from_rad(
      base::angle_diff_rad(base::rad_from_deg(truth_deg + age_deg), base::rad_from_deg(shown)));
  // scrub 128.8 Nm / 0.6 m = 214.6 N a track; both ways, plus rolling: 21.9 A, a quarter degree
  // each
  EXPECT_NEAR(error, 0.25 * 21.9 * (1.0 - std::exp(-5.3 / 2.0)), 0.4);
}

TEST(Gnss, AnOutageSaysNoFixAndTheCompassGoesOn) {
  Plant plant;
  set_fault(plant, [](Faults& f) { f.gnss_outage = true; });
  plant.wait(2s);
  EXPECT_EQ(plant.lines("GGA").back(), "$GNGGA,120001.80,,,,,0,00,99.9,,,,,,*4B");
  const auto rmc = split(plant.lines("RMC").back());
  EXPECT_EQ(rmc.at(2), "V");
  EXPECT_EQ(rmc.at(3), "");
  EXPECT_EQ(split(plant.lines("GST").back()).at(6), "");
  EXPECT_EQ(plant.lines("HDT").size(), 9u);
}

TEST(Gnss, ASilentReceiverSendsNothingAndComesBack) {
  Plant plant;
  set_fault(plant, [](Faults& f) { f.gnss_silent = true; });
  plant.wait(2s);
  EXPECT_TRUE(plant.gnss.empty());
  set_fault(plant, [](Faults& f) { f.gnss_silent = false; });
  plant.wait(1s);
  EXPECT_EQ(plant.lines("GGA").size(), 5u);
}

TEST(Gnss, AJumpLastsItsTime) {
  Plant plant;
  plant.wait(1s);
  set_fault(plant, [](Faults& f) {
    f.gnss_jump_east_m = 3.0;
    f.gnss_jump_north_m = -1.0;
    f.gnss_jump_s = 5.0;
  });
  plant.wait(4s);
  EXPECT_NEAR(local(plant, plant.lines("GGA").back()).east_m, 3.0, 1e-3);
  EXPECT_NEAR(local(plant, plant.lines("GGA").back()).north_m, -1.0, 1e-3);
  plant.wait(2s);
  EXPECT_NEAR(local(plant, plant.lines("GGA").back()).east_m, 0.0, 1e-3);
  EXPECT_EQ(plant.bunker.faults().gnss_jump_east_m, 0.0);
}

TEST(Gnss, TheFixClassCanBeForced) {
  Plant plant;
  const auto quality_of = [&](const char* word) {
    set_fault(plant, [&](Faults& f) { f.gnss_fix = word; });
    plant.wait(1s);
    return split(plant.lines("GGA").back()).at(6);
  };
  EXPECT_EQ(quality_of("rtk_float"), "5");
  EXPECT_EQ(quality_of("gps"), "1");
  EXPECT_EQ(quality_of("dgps"), "2");
  EXPECT_EQ(quality_of("none"), "0");
  EXPECT_EQ(quality_of(""), "4");
  Faults bad;
  bad.gnss_fix = "rtk";
  const auto result = plant.bunker.set_faults(bad);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().fields.at(0).pointer, "gnss_fix");
  EXPECT_EQ(plant.bunker.faults().gnss_fix, "");
}

TEST(Gnss, TheCompassCanBeSwitchedOffAndTurned) {
  Plant plant;
  set_fault(plant, [](Faults& f) { f.compass_extra_deg = -100.0; });
  plant.wait(1s);
  EXPECT_EQ(split(plant.lines("HDT").back()).at(1), "350.00");
  plant.forget();
  set_fault(plant, [](Faults& f) { f.compass_off = true; });
  plant.wait(1s);
  EXPECT_EQ(plant.lines("GGA").size(), 5u);
  EXPECT_LE(plant.lines("HDT").size(), 1u);  // the one already on its way
}

TEST(SimGnss, TheSkyIsToldOnceASecondWithAsManyUsedAsTheFixSays) {
  Plant plant;
  plant.wait(3100ms);
  EXPECT_EQ(plant.lines("GSA").size() / 4, plant.lines("GGA").size() / 5);
  const std::size_t sweeps = plant.lines("GSA").size() / 4;
  EXPECT_NEAR(static_cast<double>(sweeps), 3.0, 1.0);
  std::size_t used = 0;
  const auto gsa = plant.lines("GSA");
  for (std::size_t i = 0; i < 4; ++i) {
    const auto fields = split(gsa[i]);
    for (std::size_t k = 3; k < 15; ++k) used += fields.at(k).empty() ? 0u : 1u;
  }
  EXPECT_EQ(used, std::stoul(split(plant.lines("GGA").front()).at(7)));
  EXPECT_GE(plant.lines("GSV").size(), 8u * sweeps);
  // Without a fix nothing is used, and nothing is tracked.
  set_fault(plant, [](Faults& f) { f.gnss_outage = true; });
  plant.wait(500ms);
  plant.forget();
  plant.wait(1100ms);
  EXPECT_EQ(split(plant.lines("GSA").front()).at(3), "");
  EXPECT_EQ(split(plant.lines("GSV").front()).at(7), "");
}

}  // namespace
}  // namespace roverd::sim
