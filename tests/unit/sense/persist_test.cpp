// Rain is held back; what stays is not.
#include "nav/sense/persist.hpp"

#include <random>

#include <gtest/gtest.h>

namespace roverd::nav::sense {
namespace {

Voxel obstacle(double x, double y) {
  return {static_cast<float>(x), static_cast<float>(y), 0.3F, 1, Kind::Obstacle};
}

std::size_t believed(Persist& persist, std::vector<Voxel> voxels, const Pose2& pose = {}) {
  const std::size_t all = voxels.size();
  return all - persist.judge(voxels, pose);
}

TEST(PersistTest, AThinPoleIsBelievedAtTheThirdScan) {
  Persist persist({}, 8.0);
  EXPECT_EQ(believed(persist, {obstacle(2.0, 0.0)}), 0U);
  EXPECT_EQ(believed(persist, {obstacle(2.0, 0.0)}), 0U);
  EXPECT_EQ(believed(persist, {obstacle(2.0, 0.0)}), 1U);
}

TEST(PersistTest, AThingThatIsSeenAtSeveralPlacesAtOnceIsNotLate) {
  Persist persist({}, 8.0);
  EXPECT_EQ(believed(persist, {obstacle(2.0, 0.0), obstacle(2.05, 0.0), obstacle(2.0, 0.06)}), 3U);
}

TEST(PersistTest, AScanThatMissesItOnceOrTwiceDoesNotForgetIt) {
  Persist persist({}, 8.0);
  std::size_t last = 0;
  for (const bool seen : {true, false, true, false, true}) {
    last = seen ? believed(persist, {obstacle(2.0, 0.0)}) : (believed(persist, {}), std::size_t{0});
  }
  EXPECT_EQ(last, 1U) << "3 of 5";
}

TEST(PersistTest, APoleStaysWhereItIsWhileTheRobotDrives) {
  Persist persist({}, 8.0);
  std::size_t last = 0;
  for (int i = 0; i < 3; ++i) {
    const double x = 0.13 * i;  // 1.3 m/s at 10 Hz
    last = believed(persist, {obstacle(2.0 - x, 0.0)}, {100.0 + x, -50.0, 0.0});
  }
  EXPECT_EQ(last, 1U);
}

//   Drops at random places of a quarter circle, two per scan, 50 scans a second for a minute.
TEST(PersistTest, RainIsHeldBack) {
  Persist persist({}, 8.0);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> range(0.5, 8.0);
  std::uniform_real_distribution<double> bearing(-2.3, 2.3);
  std::size_t drops = 0;
  std::size_t passed = 0;
  for (int scan = 0; scan < 3000; ++scan) {
    std::vector<Voxel> voxels;
    for (int i = 0; i < 2; ++i) {
      const double r = range(random);
      const double b = bearing(random);
      voxels.push_back(obstacle(r * std::cos(b), r * std::sin(b)));
    }
    drops += voxels.size();
    passed += believed(persist, voxels);
  }
  EXPECT_EQ(drops, 6000U);
  EXPECT_LE(passed, 6U) << "one in a thousand";
}

//   Around a scanner with 541 beams over 270 deg, fifty scans a second, drops at one to a hundred
//   metres of beam: nearer than a metre ten beams in a hundred thousand meet the same 30 cm.
TEST(PersistTest, RainBeforeTheGlassIsHeldBackAsWell) {
  Persist persist({}, 8.0);
  constexpr double kStep = 0.5 * 3.14159265 / 180.0;
  constexpr double kPer_m = 0.01;
  std::mt19937 random(5);
  std::exponential_distribution<double> way(kPer_m);
  std::size_t near = 0;
  for (int scan = 0; scan < 3000; ++scan) {
    std::vector<Voxel> voxels;
    for (int i = 0; i < 541; ++i) {
      const double r = 0.05 + way(random);
      const double b = (i - 270) * kStep;
      if (r < 8.0) voxels.push_back(obstacle(r * std::cos(b), r * std::sin(b)));
    }
    persist.judge(voxels, {}, {0.0F, 0.0F, static_cast<float>(kStep)});
    for (const Voxel& v : voxels) {
      near += v.kind == Kind::Obstacle && std::hypot(v.x_m, v.y_m) < 0.8F ? 1U : 0U;
    }
  }
  EXPECT_EQ(near, 0U) << "a robot that stands in the rain for a minute";
}

//   The same rain, and two metres ahead a pole that gives one echo a scan. Among so many drops
//   three scans say little: it is believed later, but it is, and of a hundred thousand drops hardly
//   one.
TEST(PersistTest, TheHarderItRainsTheSurerMustBeWhatIsBelieved) {
  Persist persist({}, 8.0);
  constexpr float kStep = 0.00873F;
  std::mt19937 random(7);
  std::exponential_distribution<double> way(0.01);
  constexpr int kPoleFrom = 2900;
  std::size_t drops = 0;
  std::size_t believed_drops = 0;
  int pole_at = 0;
  for (int scan = 0; scan < 3000; ++scan) {
    std::vector<Voxel> voxels;
    for (int i = 0; i < 541; ++i) {
      const double r = 0.05 + way(random);
      const double b = (i - 270) * static_cast<double>(kStep);
      if (r < 8.0) voxels.push_back(obstacle(r * std::cos(b), r * std::sin(b)));
    }
    drops += voxels.size();
    if (scan >= kPoleFrom) voxels.push_back(obstacle(2.02, 0.02));
    persist.judge(voxels, {}, {0.0F, 0.0F, kStep});
    if (scan < kPoleFrom) {
      for (const Voxel& v : voxels) believed_drops += scan > 20 && v.kind == Kind::Obstacle;
    } else if (pole_at == 0 && voxels.back().kind == Kind::Obstacle) {
      pole_at = scan - kPoleFrom + 1;
    }
  }
  EXPECT_GT(drops, 100'000U);
  EXPECT_LE(believed_drops, 2U);
  EXPECT_GE(pole_at, 4) << "scans";
  EXPECT_LE(pole_at, 8);
}

//   A pole of 4 cm, 0.3 m before the scanner: 15 beams, each one a voxel of its own or not.
TEST(PersistTest, AThinPoleBeforeTheGlassIsBelieved) {
  Persist persist({}, 8.0);
  const Persist::From scanner{0.0F, 0.0F, 0.00873F};
  std::size_t held = 0;
  for (int scan = 0; scan < 3; ++scan) {
    std::vector<Voxel> pole{obstacle(0.3, 0.01), obstacle(0.3, -0.01)};
    pole[0].points = pole[1].points = 6;  // some of them got lost
    held = persist.judge(pole, {}, scanner);
  }
  EXPECT_EQ(held, 0U);
}

//   Sixteen rows look through the same column of air: two drops in it are no thing.
TEST(PersistTest, OfSeveralRowsMoreEchoesAreWanted) {
  const auto held = [](std::uint32_t echoes) {
    Persist persist({}, 8.0);
    std::size_t last = 0;
    for (int scan = 0; scan < 3; ++scan) {
      std::vector<Voxel> voxels{obstacle(0.5, 0.0)};
      voxels[0].points = echoes;
      last = persist.judge(voxels, {}, {0.0F, 0.0F, 0.0140F, 0.0349F});
    }
    return last;
  };
  EXPECT_EQ(held(12), 1U) << "2 cm · 8 cm at half a metre: 2.9 beams of 4.6 rows, 13.1 echoes";
  EXPECT_EQ(held(14), 0U);
}

//   A lidar of 1800 steps and sixteen rows in rain of a hundred metres between drops: at 3.3 m some
//   place has an echo in seven scans of eight by chance, once in half a minute. A post there gives
//   one in every row.
TEST(PersistTest, InHardRainOneEchoOfSeveralRowsIsNoThingHoweverOftenItIsThereAndAPostIs) {
  constexpr double kAcross = 6.2831853 / 1800.0;
  constexpr double kUp = 0.0349;
  const auto believed_with = [](std::uint32_t echoes) {
    Persist persist({}, 8.0);
    std::mt19937 random(4);
    std::exponential_distribution<double> way(0.01);
    int count = 0;
    for (int scan = 0; scan < 40; ++scan) {
      std::vector<Voxel> voxels;
      for (int i = 0; i < 1800 * 16; ++i) {
        const double r = 0.4 + way(random);
        const double b = kAcross * (i / 16);
        const double z = 0.8 + r * std::sin(kUp * (i % 16 - 7.5));
        if (r > 8.0 || z < 0.08 || z > 0.8) continue;
        const bool near = std::hypot(r * std::cos(b) - 3.3, r * std::sin(b)) < 0.25;
        if (!near) voxels.push_back(obstacle(r * std::cos(b), r * std::sin(b)));
      }
      if (scan >= 30 && scan != 34) {
        voxels.push_back(obstacle(3.3, 0.0));
        voxels.back().points = echoes;
      }
      persist.judge(voxels, {}, {0.0F, 0.0F, static_cast<float>(kAcross), static_cast<float>(kUp)});
      count += scan >= 30 && scan != 34 && voxels.back().kind == Kind::Obstacle ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(believed_with(1), 0);
  EXPECT_GE(believed_with(6), 1) << "within ten scans";
}

//   A step that a strange program told: a hundred-thousandth of a radian would ask a thing a metre
//   away for two thousand echoes.
TEST(PersistTest, HoweverFineTheStepIsSixEchoesOfARowAreEnough) {
  const auto held = [](std::uint32_t echoes) {
    Persist persist({}, 8.0);
    std::size_t last = 0;
    for (int scan = 0; scan < 3; ++scan) {
      std::vector<Voxel> voxels{obstacle(1.0, 0.0)};
      voxels[0].points = echoes;
      last = persist.judge(voxels, {}, {0.0F, 0.0F, 1e-5F});
    }
    return last;
  };
  EXPECT_EQ(held(5), 1U);
  EXPECT_EQ(held(6), 0U);
}

//   1.2 cm at 1.5 m before a scanner with half degrees: 0.92 steps, one echo; 2 cm: 1.53, and one
//   of them is sure.
TEST(PersistTest, AThingOfTheLeastWidthNeedsNoMoreEchoesThanAreSureToMeetIt) {
  Persist persist({}, 8.0);
  const Persist::From scanner{0.0F, 0.0F, 0.00873F};
  std::size_t held = 0;
  for (int scan = 0; scan < 3; ++scan) {
    std::vector<Voxel> stake{obstacle(1.5, 0.0)};
    held = persist.judge(stake, {}, scanner);
  }
  EXPECT_EQ(held, 0U);
}

TEST(PersistTest, WhatIsNoObstacleIsLeftAlone) {
  Persist persist({}, 8.0);
  std::vector<Voxel> voxels{obstacle(2.0, 0.0), obstacle(3.0, 0.0)};
  voxels[0].kind = Kind::Ground;
  EXPECT_EQ(persist.judge(voxels, {}), 1U);
  EXPECT_EQ(voxels[0].kind, Kind::Ground);
  EXPECT_EQ(voxels[1].kind, Kind::Passing);
}

}  // namespace
}  // namespace roverd::nav::sense
