#include "mission/rows/headland.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"

namespace roverd::mission {
namespace {

constexpr double kStraight_m =
    0.1;  // for less between two arcs nobody stops: they are so much wider
constexpr double kExact_m = 1e-6;

/// Turns to the change's own hand are positive here.
class Turns {
 public:
  Turns(double side, double radius_m, std::vector<Item>& items)
      : side_(side), radius_m_(radius_m), items_(items) {}

  void on_the_spot(double deg) { items_.emplace_back(TurnBy{side_ * deg, std::nullopt}); }
  void arc(double deg) { arc(deg, radius_m_); }
  void arc(double deg, double radius_m) {
    // To the millionth of a degree: more digits are of no use in a file.
    const double rounded = std::round(side_ * deg * 1e6) / 1e6;
    items_.emplace_back(TurnBy{rounded, std::nullopt, radius_m});
  }
  void straight(double by_m) { items_.emplace_back(Move{std::round(by_m * 1e6) / 1e6}); }

 private:
  double side_;
  double radius_m_;
  std::vector<Item>& items_;
};

/// Follows items from the lane's end on.
class Follower {
 public:
  void follow(const Item& item) {
    const auto* turn = std::get_if<TurnBy>(&item);
    const double turn_rad = turn ? base::rad_from_deg(turn->turn_deg.value_or(0.0)) : 0.0;
    const auto* move = std::get_if<Move>(&item);
    const double way_m = move                     ? move->forward_m
                         : turn && turn->radius_m ? *turn->radius_m * std::abs(turn_rad)
                                                  : 0.0;
    // An even number of pieces has a point in the middle, where an arc is farthest out.
    const int pieces = 2 * std::max(1, static_cast<int>(std::ceil(std::abs(way_m) / kApart_m)));
    const double half_rad = 0.5 * turn_rad / pieces;
    const double chord = turn_rad != 0.0 ? std::sin(half_rad) / half_rad : 1.0;
    for (int i = 0; i < pieces; ++i) {
      right_rad_ += half_rad;
      at_.ahead_m += way_m / pieces * chord * std::cos(right_rad_);
      at_.right_m += way_m / pieces * chord * std::sin(right_rad_);
      right_rad_ += half_rad;
      way.push_back(at_);
    }
  }

  std::vector<TurnPoint> way;

 private:
  static constexpr double kApart_m = 0.05;

  TurnPoint at_;
  double right_rad_ = 0.0;  // of where it points
};

}  // namespace

std::string_view to_string(RowTurn kind) noexcept {
  switch (kind) {
    case RowTurn::Auto:
      return "auto";
    case RowTurn::Pivot:
      return "pivot";
    case RowTurn::Arc:
      return "arc";
    case RowTurn::Omega:
      return "omega";
    case RowTurn::Shunt:
      return "shunt";
  }
  return "auto";
}

RowTurn kind_of(const LaneChange& change, const TurningVehicle& vehicle) noexcept {
  const bool wide = std::abs(change.aside_m) >= 2.0 * change.radius_m - kExact_m;
  switch (change.kind) {
    case RowTurn::Auto:
      if (!(vehicle.narrowest_m > 0.0)) return RowTurn::Pivot;
      return wide ? RowTurn::Arc : RowTurn::Shunt;
    case RowTurn::Omega:
    case RowTurn::Shunt:
      return wide ? RowTurn::Arc : change.kind;
    case RowTurn::Pivot:
    case RowTurn::Arc:
      return change.kind;
  }
  return change.kind;
}

double change_lane(const LaneChange& change, RowTurn kind, std::vector<Item>& items) {
  const double wide_m = std::abs(change.aside_m);
  const bool right = wide_m > 0.0 ? change.aside_m > 0.0 : change.hand == Side::Right;
  const double radius_m = change.radius_m;
  Turns turns(right ? 1.0 : -1.0, radius_m, items);
  turns.straight(change.out_m);
  switch (kind) {
    case RowTurn::Auto:
    case RowTurn::Pivot:
      if (!(wide_m > 0.0)) {
        turns.on_the_spot(180.0);
        return change.out_m;
      }
      turns.on_the_spot(90.0);
      turns.straight(wide_m);
      turns.on_the_spot(90.0);
      return change.out_m;
    case RowTurn::Arc: {
      const double between_m = wide_m - 2.0 * radius_m;
      if (between_m < kStraight_m) {
        const double half_m = std::max(radius_m, 0.5 * wide_m);
        turns.arc(180.0, half_m);
        return change.out_m + half_m;
      }
      turns.arc(90.0);
      turns.straight(between_m);
      turns.arc(90.0);
      return change.out_m + radius_m;
    }
    case RowTurn::Omega: {
      // Three circles that touch: the outer two lie beside the lanes, the middle one between them.
      const double swing_rad = std::acos((radius_m + 0.5 * wide_m) / (2.0 * radius_m));
      const double swing_deg = base::deg_from_rad(swing_rad);
      turns.arc(-swing_deg);
      turns.arc(180.0 + 2.0 * swing_deg);
      turns.arc(-swing_deg);
      return change.out_m + 2.0 * radius_m * std::sin(swing_rad) + radius_m;
    }
    case RowTurn::Shunt:
      turns.arc(90.0);
      turns.straight(wide_m - 2.0 * radius_m);
      turns.arc(90.0);
      return change.out_m + radius_m;
  }
  return change.out_m;
}

std::vector<TurnPoint> way_of(const std::vector<Item>& items) {
  Follower follower;
  for (const Item& item : items) follower.follow(item);
  return std::move(follower.way);
}

}  // namespace roverd::mission
