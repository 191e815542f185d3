#pragma once
// Plans for tests: one with every kind of item, and random ones from a seed.

#include <random>
#include <string>

#include "mission/plan.hpp"

namespace roverd::mission {

inline Waypoint waypoint_at(double lat, double lon) {
  Waypoint waypoint;
  waypoint.at = {lat, lon};
  return waypoint;
}

inline Plan plan_with_every_item() {
  Plan plan;
  plan.name = "Everything — „kõik“ \"x\" \\ /";
  plan.home = Home{{58.378020123456789, 26.728900987654321}, 61.25};
  plan.settings = {AtEnd::BackAndForth, 0.9};
  plan.frame = MissionMap{"shed"};
  Waypoint full = waypoint_at(-35.36256542276401, 149.16525136037512);
  full.alt_m = -12.5;
  full.speed_mps = 0.75;
  full.radius_m = 0.3;
  full.hold_s = 4.0;
  full.reverse = true;
  full.turn = Turn::Pivot;
  plan.items = {
      full,
      waypoint_at(90.0, -180.0),
      Local{-12.25, 3.5, 359.5},
      Local{1.0, 2.0, std::nullopt},
      Move{-2.5},
      TurnBy{-90.0, std::nullopt},
      TurnBy{std::nullopt, 0.0},
      Wait{0.0},
      Speed{10.0},
      Row{.side = RowSide::Right, .gap_m = 0.8, .distance_m = 12.5, .seeing = RowSeeing::Rays},
      Row{.side = RowSide::Left, .until = {58.378, 26.729, std::nullopt}},
      Wall{Side::Right, 0.9},
      Landmarks{"cone", 0.7, 0.4, 5},
      Dock{12, 0.9},
      Jump{2, 0},
      Action{"spray", {{"nozzle", 3}, {"on", true}, {"note", {1, "a", nullptr}}}},
      ReturnHome{},
      Loiter{58.1, 26.5, 30.0, 2.5},
      Loiter{},
      Circle{{58.2, 26.6}, 12.5, 2.25, true, 0.6, 8, 3.0},
      Circle{{58.2, 26.6}, 4.0, {}, false, {}, {}, {}},
      TurnBy{180.0, std::nullopt, 1.25},
      MapPoint{3.5, -2.25, 90.0, 0.5, 0.2, 3.0, true},
      MapPoint{.x_m = 1.0, .y_m = 2.0},
      Wall{.side = Side::Left, .length_m = 4.0},
      Landmarks{.name = "any", .side = Side::Right}};
  return plan;
}

class RandomPlans {
 public:
  explicit RandomPlans(std::uint32_t seed) : random_(seed) {}

  Plan next(int items) {
    Plan plan;
    plan.name = "plan " + std::to_string(whole(0, 1'000'000));
    if (coin()) plan.home = Home{position(), maybe(-1000.0, 10'000.0)};
    plan.settings.at_end = static_cast<AtEnd>(whole(0, 3));
    plan.settings.speed_mps = maybe(0.01, 10.0);
    for (int i = 0; i < items; ++i) plan.items.push_back(item(i, items));
    return plan;
  }

  /// Waypoints, waits, speeds, turns and jumps back: what every format can hold.
  Plan next_simple(int items) {
    Plan plan;
    plan.name = "simple";
    plan.home = Home{position(), 12.5};
    for (int i = 0; i < items; ++i) {
      Waypoint waypoint;
      waypoint.at = position();
      if (coin()) waypoint.hold_s = number(0.5, 60.0);
      if (coin()) waypoint.radius_m = number(0.1, 5.0);
      if (coin()) waypoint.alt_m = number(1.0, 100.0);
      plan.items.push_back(waypoint);
      if (whole(0, 9) == 0) plan.items.push_back(Wait{number(0.0, 100.0)});
      if (whole(0, 9) == 0) plan.items.push_back(Speed{number(0.1, 3.0)});
      if (whole(0, 9) == 0) plan.items.push_back(TurnBy{std::nullopt, number(0.0, 359.0)});
      if (whole(0, 9) == 0) plan.items.push_back(TurnBy{number(-359.0, 359.0), std::nullopt});
      if (whole(0, 9) == 0) {
        plan.items.push_back(Jump{whole(1, static_cast<int>(plan.items.size())), whole(0, 9)});
      }
    }
    return plan;
  }

 private:
  double number(double min, double max) {
    return std::uniform_real_distribution<double>(min, max)(random_);
  }
  int whole(int min, int max) { return std::uniform_int_distribution<int>(min, max)(random_); }
  bool coin() { return whole(0, 1) == 1; }
  std::optional<double> maybe(double min, double max) {
    return coin() ? std::optional(number(min, max)) : std::nullopt;
  }
  LatLon position() { return {number(-90.0, 90.0), number(-180.0, 180.0)}; }
  Side side() { return coin() ? Side::Left : Side::Right; }

  Item item(int index, int items) {
    switch (whole(0, 12)) {
      case 0:
        return Local{number(-1e4, 1e4), number(-1e4, 1e4), maybe(0.0, 359.0)};
      case 1:
        return Move{number(-10.0, 10.0)};
      case 2:
        return coin() ? TurnBy{number(-360.0, 360.0), std::nullopt}
                      : TurnBy{std::nullopt, number(0.0, 359.9)};
      case 3:
        return Wait{number(0.0, 86'400.0)};
      case 4:
        return Speed{number(0.001, 10.0)};
      case 5:
        return Row{static_cast<RowSide>(whole(0, 2)), maybe(0.1, 20.0), maybe(0.01, 10.0),
                   maybe(0.1, 500.0), coin() ? RowSeeing::Line : RowSeeing::Rays};
      case 6:
        return Wall{side(), maybe(0.1, 20.0)};
      case 7:
        return coin() ? Landmarks{"cone", number(-20.0, 20.0), maybe(0.01, 10.0)}
                      : Landmarks{.name = "cone", .side = side()};
      case 8: {
        const int to = whole(1, items);
        if (to != index + 1) return Jump{to, whole(0, 100)};
        return ReturnHome{};
      }
      case 9:
        return Action{"horn", {{"times", whole(1, 5)}, {"volume", number(0.0, 1.0)}}};
      case 10: {
        Loiter loiter{{}, {}, maybe(0.0, 86'400.0), maybe(0.1, 100.0)};
        if (coin()) {
          const LatLon at = position();
          loiter.lat = at.lat;
          loiter.lon = at.lon;
        }
        return loiter;
      }
      case 11: {
        Circle circle{
            position(), number(0.5, 1000.0), maybe(0.05, 1000.0), coin(), maybe(0.001, 10.0),
            {},         maybe(0.0, 86'400.0)};
        if (coin()) circle.stations = whole(0, 36);
        return circle;
      }
      default: {
        Waypoint waypoint;
        waypoint.at = position();
        waypoint.alt_m = maybe(-1000.0, 10'000.0);
        waypoint.speed_mps = maybe(0.001, 10.0);
        waypoint.radius_m = maybe(0.001, 100.0);
        waypoint.hold_s = maybe(0.0, 86'400.0);
        waypoint.reverse = coin();
        waypoint.turn = static_cast<Turn>(whole(0, 3));
        return waypoint;
      }
    }
  }

  std::mt19937 random_;
};

}  // namespace roverd::mission
