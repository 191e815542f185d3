// Another map while the program runs: what the robot is told, and where the map lies.

#include "app/place_loop.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "base/time.hpp"

namespace roverd {
namespace {

using namespace std::chrono_literals;

constexpr base::LatLon kAt{58.378, 26.729};

PlaceLoop::Map room(std::string name, std::uint32_t number,
                    std::optional<nav::place::MapAnchor> anchor) {
  auto map = *nav::chart::OccupancyMap::make({40, 40, 0.1, {}}, nav::chart::kFree);
  for (std::int32_t i = 0; i < 40; ++i) map.set({i, 0}, nav::chart::kOccupied);
  nav::place::MapInUse out;
  out.name = std::move(name);
  out.number = number;
  out.field = std::make_shared<const nav::place::Field>(map);
  out.anchor = anchor;
  return std::make_shared<const nav::place::MapInUse>(std::move(out));
}

class PlaceLoopTest : public ::testing::Test {
 protected:
  /// What the robot knows of its place, once `claim` holds of it; 10 s.
  base::PlaceState told(const std::function<bool(const base::PlaceState&)>& claim) {
    for (const auto end = std::chrono::steady_clock::now() + 10s;;) {
      robot_.tick(base::steady_now(), base::wall_now());
      const auto place = robot_.snapshot()->place;
      if (place && claim(*place)) return *place;
      if (std::chrono::steady_clock::now() > end) {
        ADD_FAILURE() << "not within 10 s";
        return {};
      }
      std::this_thread::sleep_for(2ms);
    }
  }
  base::PlaceState told_of(const std::string& map) {
    return told([&map](const base::PlaceState& place) { return place.map == map; });
  }
  bool placed_soon() {
    for (int i = 0; i < 1000 && !loop_.placed(); ++i) std::this_thread::sleep_for(10ms);
    return loop_.placed() != nullptr;
  }

  robot::Robot robot_{robot::Config{}};
  PlaceLoop loop_{robot_, nullptr, {}, {}};
};

TEST_F(PlaceLoopTest, TakesAnotherMapWithoutARestart) {
  EXPECT_EQ(told_of("").phase, base::PlacePhase::Off);
  EXPECT_EQ(loop_.placed(), nullptr);
  loop_.use(room("shed", 1, nav::place::MapAnchor{kAt, base::yaw_from_heading(30.0), 0.2, 0.01}),
            false);
  EXPECT_EQ(told_of("shed").phase, base::PlacePhase::Searching);
  ASSERT_TRUE(placed_soon());
  const maps::Anchor anchor = told_anchor(*loop_.placed());
  EXPECT_EQ(anchor.at.lat, kAt.lat);
  EXPECT_NEAR(anchor.heading_deg, 30.0, 1e-9);
  EXPECT_NEAR(anchor.heading_accuracy_deg, base::deg_from_rad(0.01), 1e-9);
  // One that nobody has laid anywhere: never that of the map before.
  loop_.use(room("barn", 2, {}), false);
  EXPECT_EQ(loop_.placed(), nullptr);
  EXPECT_EQ(told_of("barn").phase, base::PlacePhase::Searching);
  EXPECT_EQ(loop_.placed(), nullptr);
  loop_.use(nullptr, false);
  EXPECT_EQ(told_of("").phase, base::PlacePhase::Off);
}

TEST_F(PlaceLoopTest, TheLastOfManyChoicesHolds) {
  for (std::uint32_t i = 1; i <= 20; ++i) loop_.use(room(std::to_string(i), i, {}), i % 2 == 0);
  EXPECT_EQ(told_of("20").phase, base::PlacePhase::Searching);
}

}  // namespace
}  // namespace roverd
