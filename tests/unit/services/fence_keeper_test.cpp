// The fence that holds: what was chosen, and what is kept out of beside it.

#include "services/fence_keeper.hpp"

#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace roverd::services {
namespace {

mission::FenceArea square(mission::AreaKind kind, double lat, double size) {
  return {kind,
          mission::FencePolygon{
              {{lat, 26.0}, {lat, 26.0 + size}, {lat + size, 26.0 + size}, {lat + size, 26.0}}}};
}

class FenceKeeperTest : public ::testing::Test {
 protected:
  /// Name of the fence that the robot keeps; "none".
  std::string held() {
    now_ += std::chrono::milliseconds(20);
    robot_.tick(now_, base::kYoungest + std::chrono::hours(1));
    const auto& fence = robot_.snapshot()->fence;
    return fence ? fence->name : "none";
  }

  base::Time now_ = base::Time{} + std::chrono::seconds(10);
  robot::Robot robot_{robot::Config{}};
  FenceKeeper keeper_{robot_};
  const mission::FenceArea rack_ = square(mission::AreaKind::Exclusion, 58.001, 1e-4);
  const mission::Fence yard_{"yard", {square(mission::AreaKind::Inclusion, 58.0, 1e-2)}, {}};
};

TEST_F(FenceKeeperTest, WhatIsKeptOutOfIsAFenceWhereNoneIsChosen) {
  EXPECT_EQ(held(), "none");
  keeper_.keep_out({rack_}, "forbidden in hall");
  EXPECT_EQ(held(), "forbidden in hall");
  ASSERT_EQ(keeper_.fence()->areas.size(), 1u);
  keeper_.keep_out({}, "");
  EXPECT_EQ(held(), "none");
  EXPECT_EQ(keeper_.fence(), nullptr);
}

TEST_F(FenceKeeperTest, AChosenFenceKeepsItsNameAndGetsTheAreas) {
  keeper_.keep_out({rack_}, "forbidden in hall");
  keeper_.use(std::make_shared<const mission::Fence>(yard_), {});
  EXPECT_EQ(held(), "yard");
  ASSERT_EQ(keeper_.fence()->areas.size(), 2u);
  EXPECT_EQ(keeper_.fence()->areas[1], rack_);
  keeper_.use(nullptr, {});
  EXPECT_EQ(held(), "forbidden in hall") << "what is forbidden stays so without a fence";
  keeper_.use(std::make_shared<const mission::Fence>(yard_), {});
  keeper_.keep_out({}, "");
  EXPECT_EQ(held(), "yard");
  EXPECT_EQ(*keeper_.fence(), yard_);
}

TEST_F(FenceKeeperTest, NoMoreHoldsThanAFenceMayHaveAndWhatDoesNotIsCounted) {
  mission::Fence many = yard_;
  many.areas.resize(98, yard_.areas[0]);
  keeper_.keep_out({rack_, rack_, rack_}, "forbidden in hall");
  EXPECT_EQ(keeper_.left_out(), 0u);
  keeper_.use(std::make_shared<const mission::Fence>(many), {});
  EXPECT_EQ(keeper_.fence()->areas.size(), mission::kMaxAreas);
  EXPECT_EQ(keeper_.left_out(), 1u);
  keeper_.use(nullptr, {});
  EXPECT_EQ(keeper_.left_out(), 0u);
}

}  // namespace
}  // namespace roverd::services
