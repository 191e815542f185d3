#pragma once
// Missions for tests of the executor, and an ideal robot that drives them.

#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "nav/behave/executor.hpp"

namespace roverd::nav {

inline const base::LocalFrame kFrame{1, {58.378, 26.729}};

inline mission::Waypoint at(double east_m, double north_m) {
  mission::Waypoint w;
  w.at = kFrame.to_global({east_m, north_m});
  return w;
}

inline mission::Waypoint far_away() {
  mission::Waypoint w;
  w.at = {59.0, 26.7};
  return w;
}

inline mission::Plan plan(std::vector<mission::Item> items,
                          mission::AtEnd at_end = mission::AtEnd::Hold) {
  mission::Plan p;
  p.items = std::move(items);
  p.settings.at_end = at_end;
  return p;
}

/// An ideal robot that does at once what it is told.
struct Ride {
  base::Setting<PathParams> path;
  BehaveParams behave;
  Executor executor{path, behave};
  Vehicle vehicle;
  std::optional<EnuPoint> home = EnuPoint{0, 0};
  std::vector<int> reached;
  std::vector<int> missed;
  int laps = 0;

  void load(const mission::Plan& p) {
    auto route = lay_route(p, kFrame, {});
    ASSERT_TRUE(route) << route.error().detail;
    executor.load(std::make_shared<const Route>(std::move(*route)));
  }
  std::shared_ptr<const Route> route_of(const mission::Plan& p) {
    auto route = lay_route(p, kFrame, {});
    EXPECT_TRUE(route);
    return std::make_shared<const Route>(std::move(*route));
  }
  void extend(const mission::Plan& p) { executor.extend(route_of(p)); }
  void drop(const mission::Plan& p, int item) { executor.drop(route_of(p), item); }
  void start(StartAt from = {}) {
    const auto ok = executor.start(from, vehicle.at, home);
    ASSERT_TRUE(ok) << ok.error().detail;
  }
  void tick() {
    const auto t = executor.step(vehicle, 10.0, home, 0.02).command;
    const bool runs = executor.running();
    vehicle.speed_mps = runs ? t.linear_mps : 0.0;
    vehicle.yaw_rate_radps = runs ? t.angular_radps : 0.0;
    vehicle.at.east_m += vehicle.speed_mps * 0.02 * std::cos(vehicle.yaw_rad);
    vehicle.at.north_m += vehicle.speed_mps * 0.02 * std::sin(vehicle.yaw_rad);
    vehicle.yaw_rad = base::wrap_rad(vehicle.yaw_rad + vehicle.yaw_rate_radps * 0.02);
    for (const Notice& n : executor.notices()) {
      if (n.kind == Notice::Kind::ItemReached) reached.push_back(n.item);
      if (n.kind == Notice::Kind::ItemMissed) missed.push_back(n.item);
      if (n.kind == Notice::Kind::Lap) ++laps;
    }
    executor.notices().clear();
  }
  bool run(double seconds) {
    for (int i = 0; i < seconds * 50.0; ++i) {
      tick();
      if (!executor.running()) return true;
    }
    return false;
  }
};

}  // namespace roverd::nav
