#include "mission/guarded.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include "mission/text.hpp"

namespace roverd::mission {
namespace {

class Guarded {
 public:
  Guarded(const Plan& plan, const VehicleLimits& vehicle) : plan_(plan), vehicle_(vehicle) {}

  std::vector<Finding> run() {
    for (std::size_t i = 0; i < plan_.items.size(); ++i) {
      item_ = static_cast<int>(i) + 1;
      const Item& item = plan_.items[i];
      if (const auto* wall = std::get_if<Wall>(&item)) {
        beside(wall->distance_m.value_or(vehicle_.wall_m), "wall");
      }
      if (const auto* row = std::get_if<Row>(&item)) this->row(*row);
      if (goes_back(item)) back();
      if (spins(item)) spin();
    }
    return std::move(out_);
  }

 private:
  void add(Severity severity, const char* code, std::string detail) {
    out_.push_back(
        {severity, code, "/items/" + std::to_string(item_ - 1), item_, std::move(detail)});
  }

  void beside(double asked_m, const char* what) {
    const double least_m = vehicle_.room_m;
    if (!(asked_m < least_m - 1e-6)) return;
    add(Severity::Error, "too_near",
        "asks for " + fixed_number(asked_m, 2) + " m from the " + what + "; the guard needs " +
            fixed_number(std::ceil(least_m * 100.0 - 1e-6) / 100.0, 2) +
            " m there: half the vehicle's width, sense.protect.side_m and half of a cell");
  }

  void row(const Row& row) {
    if (!row.gap_m) return;
    if (row.side == RowSide::Both) {
      add(Severity::Warning, "no_effect",
          "has a gap_m, which does not act where both sides lead: it is driven in their middle");
      return;
    }
    beside(*row.gap_m, "plants");
  }

  static bool goes_back(const Item& item) {
    if (const auto* move = std::get_if<Move>(&item)) return move->forward_m < 0.0;
    if (const auto* way = std::get_if<Waypoint>(&item)) return way->reverse;
    if (const auto* point = std::get_if<MapPoint>(&item)) return point->reverse;
    return false;
  }
  bool spins(const Item& item) const {
    if (vehicle_.turn_radius_m > 0.0) return false;
    if (const auto* turn = std::get_if<TurnBy>(&item)) return !turn->radius_m;
    const auto* way = std::get_if<Waypoint>(&item);
    return way != nullptr && way->turn == Turn::Pivot;
  }

  /// Each is told once: of one such item it is known of all.
  void back() {
    if (vehicle_.sees_behind || vehicle_.creeps_back || std::exchange(told_back_, true)) return;
    add(Severity::Warning, "unseen_way",
        "is driven backwards, and no sensor looks there: it will stand where nobody has seen the "
        "way, for sense.protect.creep_back_mps is 0");
  }
  void spin() {
    if (vehicle_.sees_around || vehicle_.creeps_turning || std::exchange(told_spin_, true)) return;
    add(Severity::Warning, "unseen_way",
        "is turned on the spot, and no sensor looks around: it will stand where nobody has seen "
        "the ground beside it, for sense.protect.creep_turn_radps is 0");
  }

  const Plan& plan_;
  const VehicleLimits& vehicle_;
  std::vector<Finding> out_;
  int item_ = 0;
  bool told_back_ = false;
  bool told_spin_ = false;
};

}  // namespace

std::vector<Finding> guarded_findings(const Plan& plan, const VehicleLimits& vehicle) {
  return Guarded(plan, vehicle).run();
}

}  // namespace roverd::mission
