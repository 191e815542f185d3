// A drive by hand becomes a map, beside everything else.

#include "app/map_maker.hpp"

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "base/time.hpp"
#include "nav/cells/map_file.hpp"
#include "unit/place/shed.hpp"

namespace roverd {
namespace {

using namespace std::chrono_literals;
using nav::chart::Pose2;

constexpr base::Mount kMount{.z_m = 0.3};

class MapMakerTest : public ::testing::Test {
 protected:
  /// One step of a tenth of a second, and what the scanner sees then.
  void step(double ahead_m, double turn_rad) {
    time_s_ += 0.1;
    const Pose2 moved = nav::sense::along(ahead_m / 0.1, turn_rad / 0.1, 0.1);
    at_ = at_ * moved;
    odometry_ = odometry_ * moved;
    const base::Time now = base::Time{} + base::from_seconds(time_s_);
    auto sight = std::make_shared<base::Sight>();
    sight->sensor = "front";
    sight->stamp = now;
    for (int i = -135; i <= 135; ++i) {
      const double angle = base::rad_from_deg(i);
      const double range = tests::range_m(walls_, at_.x_m, at_.y_m, at_.yaw_rad + angle);
      base::SightPoint p;
      p.x_m = static_cast<float>(range * std::cos(angle));
      p.y_m = static_cast<float>(range * std::sin(angle));
      p.echo = range > 0.0 ? base::Echo::Hit : base::Echo::Unknown;
      sight->points.push_back(p);
    }
    nav::sense::Odometry o;
    o.stamp = now;
    o.pose = odometry_;
    std::vector<std::shared_ptr<const base::Sight>> sights{sight};
    if (lidar_) sights.push_back(seen_by_lidar(now));
    maker_.take(sights, {o});
  }
  /// Five rows a metre above the ground: four on the walls, one on the ground two metres around.
  std::shared_ptr<const base::Sight> seen_by_lidar(base::Time now) const {
    auto sight = std::make_shared<base::Sight>();
    sight->sensor = "top";
    sight->stamp = now;
    for (int i = 0; i < 360; ++i) {
      const double angle = base::rad_from_deg(i);
      const double range = tests::range_m(walls_, at_.x_m, at_.y_m, at_.yaw_rad + angle);
      for (std::uint8_t ring = 0; ring < 5; ++ring) {
        const double flat_m = ring == 0 ? 1.5 + 0.1 * (i % 10) : range;
        if (range <= 0.0 || flat_m > range) continue;
        base::SightPoint p;
        p.x_m = static_cast<float>(flat_m * std::cos(angle));
        p.y_m = static_cast<float>(flat_m * std::sin(angle));
        p.z_m = ring == 0 ? -1.0F : 0.4F * static_cast<float>(ring) - 1.0F;
        p.ring = ring;
        p.echo = base::Echo::Hit;
        sight->points.push_back(p);
      }
    }
    return sight;
  }
  /// So many scans have been laid together; 20 s.
  bool laid(std::size_t scans) {
    for (int i = 0; i < 2000; ++i) {
      const auto now = maker_.progress();
      if (!now || now->scans >= scans) return now.has_value();
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }

  base::Result<maps::About> finish() {
    return maker_.finish([this](const maps::Made& made) -> base::Result<maps::About> {
      if (full_) return base::fail(base::Code::Conflict, "200 maps are kept already");
      made_ = made;
      return maps::About{};
    });
  }

  bool full_ = false;  ///< the shelf
  bool lidar_ = false;
  std::optional<maps::Made> made_;
  const std::vector<tests::Segment> walls_ = tests::shed();
  Pose2 at_{2.5, 3.0, 0.1};
  Pose2 odometry_{5.0, -3.0, 1.0};
  double time_s_ = 100.0;
  robot::Robot robot_{robot::Config{}};
  MapMaker maker_{robot_, {{"front", kMount}, {"top", {.z_m = 1.0}}}, {"front", "top"}};
};

TEST_F(MapMakerTest, DrawsWhatWasSeenOnTheWay) {
  EXPECT_FALSE(maker_.progress());
  EXPECT_EQ(finish().error().code, base::Code::Conflict);
  ASSERT_TRUE(maker_.start());
  EXPECT_EQ(maker_.start().error().code, base::Code::Conflict);
  for (std::size_t i = 1; i <= 30; ++i) {
    step(0.1, 0.02);
    ASSERT_TRUE(laid(i));
  }
  for (int i = 0; i < 5; ++i) step(0.0, 0.0);  // who stands adds nothing
  EXPECT_NEAR(maker_.progress()->way_m, 2.9, 1e-3);
  const auto kept = finish();
  ASSERT_TRUE(kept) << kept.error().detail;
  EXPECT_FALSE(maker_.progress());
  EXPECT_FALSE(made_->anchor) << "no satellites were heard";
  // Each wall that the last scan saw is occupied in the map, and where the robot drove it is free.
  const Pose2 x_ow = odometry_ * inverse(at_);  // the map's frame is that of the first odometry
  const auto seen_as = [&](double x_m, double y_m) {
    const Pose2 p = x_ow * Pose2{x_m, y_m, 0.0};
    const auto cell = made_->map.cell_of(p.x_m, p.y_m);
    return cell ? made_->map.at(*cell) : nav::chart::kUnknown;
  };
  EXPECT_LE(seen_as(at_.x_m, at_.y_m), nav::chart::kSurelyFree);
  int hits = 0;
  for (int i = -130; i <= 130; i += 10) {
    const double angle = at_.yaw_rad + base::rad_from_deg(i);
    const double range = tests::range_m(walls_, at_.x_m, at_.y_m, angle);
    if (range <= 0.0) continue;
    bool hit = false;  // within a cell or two
    for (double r = range - 0.08; r <= range + 0.08; r += 0.02) {
      hit = hit || seen_as(at_.x_m + r * std::cos(angle), at_.y_m + r * std::sin(angle)) >=
                       nav::chart::kSurelyOccupied;
    }
    hits += hit ? 1 : 0;
  }
  EXPECT_GE(hits, 22);  // of 27
}

TEST_F(MapMakerTest, ALidarOfSeveralRowsGivesItAThirdDimension) {
  lidar_ = true;
  ASSERT_TRUE(maker_.start());
  for (std::size_t i = 1; i <= 30; ++i) {
    step(0.2, 0.02);
    ASSERT_TRUE(laid(i));
  }
  const auto kept = finish();
  ASSERT_TRUE(kept) << kept.error().detail;
  const auto cells = nav::cells::read_map(made_->solid, 0.2);
  ASSERT_TRUE(cells) << cells.error().detail;
  // What stands lies on the walls of the plane, at the heights of the rows.
  const Pose2 x_wo = at_ * inverse(odometry_);
  std::size_t stands = 0;
  std::size_t on_wall = 0;
  for (const nav::cells::Cell& c : cells->cells()) {
    if (c.mean_m.z() < 0.3) continue;
    const Pose2 p = x_wo * Pose2{c.mean_m.x(), c.mean_m.y(), 0.0};
    ++stands;
    for (const tests::Segment& w : walls_) {
      const double ex = w.bx_m - w.ax_m;
      const double ey = w.by_m - w.ay_m;
      const double off = ((p.x_m - w.ax_m) * ey - (p.y_m - w.ay_m) * ex) / std::hypot(ex, ey);
      if (std::abs(off) < 0.06) {
        ++on_wall;
        break;
      }
    }
    EXPECT_LT(c.mean_m.z(), 1.7);
  }
  EXPECT_GT(stands, 300U);
  EXPECT_GT(static_cast<double>(on_wall), 0.95 * static_cast<double>(stands));
}

TEST_F(MapMakerTest, OfAFewStepsThereIsThePlaneOnly) {
  lidar_ = true;
  ASSERT_TRUE(maker_.start());
  for (std::size_t i = 1; i <= 5; ++i) {
    step(0.2, 0.0);
    ASSERT_TRUE(laid(i));
  }
  ASSERT_TRUE(finish());
  EXPECT_TRUE(made_->solid.empty());
}

TEST_F(MapMakerTest, WithoutASightThereIsNoMapAndTheNextOneBeginsAnew) {
  step(0.1, 0.0);  // before it was begun: not a part of it
  ASSERT_TRUE(maker_.start());
  EXPECT_EQ(finish().error().code, base::Code::Conflict);
  EXPECT_FALSE(maker_.progress());
  ASSERT_TRUE(maker_.start());
  step(0.1, 0.0);
  ASSERT_TRUE(laid(1));
  maker_.cancel();
  EXPECT_FALSE(maker_.progress());
  ASSERT_TRUE(maker_.start());
  EXPECT_EQ(maker_.progress()->scans, 0u);
}

TEST_F(MapMakerTest, WhatCouldNotBeKeptIsNotLost) {
  ASSERT_TRUE(maker_.start());
  for (std::size_t i = 1; i <= 5; ++i) {
    step(0.1, 0.0);
    ASSERT_TRUE(laid(i));
  }
  full_ = true;
  EXPECT_EQ(finish().error().code, base::Code::Conflict);
  ASSERT_TRUE(maker_.progress());
  EXPECT_EQ(maker_.progress()->trouble, "the map is not kept yet: 200 maps are kept already");
  EXPECT_EQ(maker_.progress()->scans, 5u);
  EXPECT_EQ(maker_.start().error().code, base::Code::Conflict) << "it would be lost by that";
  step(0.1, 0.0);  // not a part of it any more
  full_ = false;   // a person made room
  ASSERT_TRUE(finish());
  EXPECT_TRUE(made_);
  EXPECT_FALSE(maker_.progress());
  EXPECT_TRUE(maker_.start());
}

TEST_F(MapMakerTest, AWideDriveIsDrawnInLargerCells) {
  ASSERT_TRUE(maker_.start());
  step(0.1, 0.0);
  ASSERT_TRUE(laid(1));
  odometry_.x_m += 400.0;  // more than 40 million cells of 5 cm
  odometry_.y_m += 400.0;
  time_s_ += 400.0;
  step(0.1, 0.0);
  ASSERT_TRUE(laid(2));
  EXPECT_EQ(maker_.progress()->trouble, "");
  const auto kept = finish();
  ASSERT_TRUE(kept) << kept.error().detail;
  EXPECT_EQ(made_->map.shape().resolution_m, 0.1);
}

TEST_F(MapMakerTest, WhatWouldBeTooLargeToKeepIsToldOnTheWay) {
  ASSERT_TRUE(maker_.start());
  step(0.1, 0.0);
  ASSERT_TRUE(laid(1));
  odometry_.x_m += 1200.0;
  odometry_.y_m += 1200.0;
  time_s_ += 1200.0;
  step(0.1, 0.0);
  ASSERT_TRUE(laid(2));
  EXPECT_EQ(maker_.progress()->trouble,
            "no more is taken: the map is as large as it may be. Stop to keep it");
  const auto kept = finish();
  ASSERT_TRUE(kept) << kept.error().detail;
  EXPECT_EQ(made_->map.shape().resolution_m, 0.2);
}

TEST_F(MapMakerTest, WhatWasKeptMeanwhileIsNotDropped) {
  EXPECT_EQ(maker_.drop().error().code, base::Code::Conflict);
  ASSERT_TRUE(maker_.start());
  step(0.1, 0.0);
  ASSERT_TRUE(laid(1));
  const auto kept = maker_.finish([this](const maps::Made&) -> base::Result<maps::About> {
    std::thread other([this] { EXPECT_EQ(maker_.drop().error().code, base::Code::Conflict); });
    other.join();
    return maps::About{};
  });
  EXPECT_TRUE(kept);
  EXPECT_EQ(maker_.drop().error().code, base::Code::Conflict);
  ASSERT_TRUE(maker_.start());
  EXPECT_TRUE(maker_.drop());
  EXPECT_FALSE(maker_.progress());
}

TEST_F(MapMakerTest, WhatCannotBeKeptForAnyReasonStays) {
  ASSERT_TRUE(maker_.start());
  step(0.1, 0.0);
  ASSERT_TRUE(laid(1));
  const auto kept = maker_.finish([](const maps::Made&) -> base::Result<maps::About> {
    throw std::runtime_error("the disk is gone");
  });
  ASSERT_FALSE(kept);
  EXPECT_EQ(maker_.progress()->trouble, "the map is not kept yet: the disk is gone");
  EXPECT_TRUE(finish());
}

TEST_F(MapMakerTest, WhileOneIsDrawnAllOthersAreRefusedAtOnce) {
  ASSERT_TRUE(maker_.start());
  step(0.1, 0.0);
  ASSERT_TRUE(laid(1));
  const auto kept = maker_.finish([this](const maps::Made&) -> base::Result<maps::About> {
    std::thread other([this] {
      EXPECT_EQ(maker_.start().error().code, base::Code::Conflict);
      EXPECT_EQ(finish().error().code, base::Code::Conflict);
      EXPECT_TRUE(maker_.progress());
    });
    other.join();
    return maps::About{};
  });
  EXPECT_TRUE(kept);
}

TEST_F(MapMakerTest, AScannerThatFallsSilentIsTold) {
  ASSERT_TRUE(maker_.start());
  const auto told = [this] {
    for (int i = 0; i < 1000 && maker_.progress()->trouble.empty(); ++i) {
      std::this_thread::sleep_for(10ms);
    }
    return maker_.progress()->trouble;
  };
  EXPECT_EQ(told(), "no sensor sees anything of which a map could be made");
  step(0.1, 0.0);
  ASSERT_TRUE(laid(1));
  for (int i = 0; i < 500 && !maker_.progress()->trouble.empty(); ++i) {
    std::this_thread::sleep_for(10ms);
  }
  EXPECT_EQ(maker_.progress()->trouble, "");
  EXPECT_EQ(told(), "nothing has come from front for three seconds");
}

}  // namespace
}  // namespace roverd
