#include "mission/rows/block.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"
#include "mission/rows/ends.hpp"
#include "mission/text.hpp"

namespace roverd::mission {
namespace {

constexpr double kRoomy = 1.1;  // times the narrowest: a car steers with the rest
constexpr double kRunUp = 1.5;  // radii, to come to row 1 along it
constexpr double kLeastRunUp_m = 2.0;
constexpr double kNear_m = 0.3;  // so much nearer to a row nobody drives up to it

std::string tenths_up(double value) {
  return fixed_number(std::ceil(value * 10.0 - 1e-6) / 10.0, 1);
}

class RowsPlanner {
 public:
  RowsPlanner(const RowBlock& block, const TurningVehicle& vehicle)
      : block_(block),
        vehicle_(vehicle),
        steered_(vehicle.narrowest_m > 0.0),
        ends_(block.lanes, block.spacing_m) {}

  base::Result<PlannedRows> plan() {
    check();
    if (wrong_.empty()) check_turns();
    if (wrong_.empty()) {
      come_to_row_1();
      drive();
    }
    if (!wrong_.empty()) {
      return base::fail(base::Code::Invalid, wrong_[0].pointer + ' ' + wrong_[0].detail, wrong_);
    }
    return std::move(out_);
  }

 private:
  void check() {
    const RowBlock& b = block_;
    const auto within = [this](const char* at, double value, double least, double most,
                               const char* words) {
      if (!(value >= least && value <= most)) wrong_.push_back({at, words});
    };
    within("/rows", b.rows, 1, kMostRows, "must be from 1 to 1000");
    within("/spacing_m", b.spacing_m, 0.3, 50.0, "must be from 0.3 to 50");
    within("/skip", b.skip, 0, 20, "must be from 0 to 20");
    if (b.rows > 1 && b.skip >= b.rows && b.skip <= 20) {
      wrong_.push_back(
          {"/skip", "must be less than rows: so many lanes are not there to leave out"});
    }
    within("/out_m", b.out_m, 0.1, kFarthestOut_m,
           "must be from 0.1 to 6: farther off the next row is not seen");
    if (b.radius_m) within("/radius_m", *b.radius_m, 0.1, 100.0, "must be from 0.1 to 100");
    if (b.entry && !base::is_valid(*b.entry)) wrong_.push_back({"/entry", "is no place on earth"});
    if (b.entry && !b.heading_deg) wrong_.push_back({"/heading_deg", "is needed with an entry"});
    if (b.heading_deg)
      within("/heading_deg", *b.heading_deg, 0.0, 359.999999, "must be from 0 to 360");
  }

  /// Those that this vehicle cannot drive.
  void check_turns() {
    if (vehicle_.pulls) {
      wrong_.push_back({"/rows", "cannot be driven by sight with a trailer (nav.tool.trailer_m)"});
      return;
    }
    if (steered_ && block_.heading_deg && !block_.entry) {
      wrong_.push_back(
          {"/heading_deg", "needs an entry: this vehicle cannot turn where it stands"});
    }
    if (block_.rows == 1) return;
    if (steered_ && block_.turn_kind == RowTurn::Pivot) {
      wrong_.push_back({"/turn_kind",
                        "this vehicle cannot turn on the spot: must be arc, omega, shunt or auto"});
    }
    if (block_.radius_m && *block_.radius_m < vehicle_.narrowest_m) {
      wrong_.push_back({"/radius_m", "must be at least " + tenths_up(vehicle_.narrowest_m) +
                                         ": this vehicle turns no narrower"});
    }
    const bool spins =
        block_.turn_kind == RowTurn::Pivot || (block_.turn_kind == RowTurn::Auto && !steered_);
    if (block_.radius_m && spins) {
      wrong_.push_back({"/radius_m",
                        "acts with arcs alone, and this turns on the spot: turn_kind must be arc, "
                        "omega or shunt"});
    }
    const bool swings = block_.turn_kind == RowTurn::Omega || block_.turn_kind == RowTurn::Shunt;
    if (swings && !steered_ && !block_.radius_m) {
      wrong_.push_back({"/radius_m",
                        "is required: this vehicle turns on the spot, so that its "
                        "profile does not tell one"});
    }
    if (block_.turn_kind != RowTurn::Arc) return;
    const double least_m = block_.alternating ? narrowest_change_m() : 0.0;
    const double radius_m = this->radius_m(least_m);
    if (least_m >= 2.0 * radius_m - 1e-6 && radius_m > 0.0) return;
    wrong_.push_back(
        {"/turn_kind", block_.alternating
                           ? "arcs with a radius of " +
                                 fixed_number(std::round(radius_m * 10.0) / 10.0, 1) +
                                 " m need lanes " + tenths_up(2.0 * radius_m) +
                                 " m apart: must be omega or shunt, or leave rows out (skip)"
                           : "no arc leads back into the same row: must be omega, shunt, pivot or "
                             "auto"});
  }

  double narrowest_change_m() const {
    const std::vector<int> order = order_of(block_);
    int least = kMostRows;
    for (std::size_t i = 1; i < order.size(); ++i) {
      least = std::min(least, std::abs(order[i] - order[i - 1]));
    }
    return least * block_.spacing_m;
  }

  /// @param aside_m between the lanes. A vehicle that turns anyhow goes round in one half circle.
  double radius_m(double aside_m) const {
    if (block_.radius_m) return *block_.radius_m;
    return steered_ ? std::ceil(kRoomy * vehicle_.narrowest_m * 10.0) / 10.0 : 0.5 * aside_m;
  }

  void come_to_row_1() {
    if (!block_.entry) {
      if (block_.heading_deg) out_.items.emplace_back(TurnBy{std::nullopt, block_.heading_deg});
      return;
    }
    Waypoint entry;
    entry.at = *block_.entry;
    if (steered_) {
      // It cannot turn there: it comes along the row.
      const double run_m = std::max(kLeastRunUp_m, kRunUp * radius_m(0.0));
      Waypoint before;
      before.at = along(entry.at, base::yaw_from_heading(*block_.heading_deg), -run_m);
      out_.items.emplace_back(before);
    }
    out_.items.emplace_back(entry);
    if (!steered_) out_.items.emplace_back(TurnBy{std::nullopt, block_.heading_deg});
  }

  static LatLon along(LatLon from, double yaw_rad, double by_m) {
    return base::TangentPlane(from).to_global({by_m * std::cos(yaw_rad), by_m * std::sin(yaw_rad)});
  }

  void drive() {
    const std::vector<int> order = order_of(block_);
    bool forth = true;
    for (std::size_t i = 0; i < order.size(); ++i) {
      row(order[i], forth);
      if (i + 1 == order.size()) break;
      const int aside = order[i + 1] - order[i];
      if (!block_.alternating) {
        change(order[i], 0, aside, forth);
        forth = !forth;
        row(order[i], forth);
      }
      change(order[i], aside, aside, forth);
      forth = !forth;
      if (!wrong_.empty()) return;
    }
    out_.items.emplace_back(Move{block_.out_m});
    out_.headland_m = std::max(out_.headland_m, block_.out_m);
  }

  void row(int number, bool forth) {
    Row row = block_.row;
    const auto lane = static_cast<std::size_t>(number - 1);
    if (lane < block_.lanes.size()) {
      const auto& [begin, end] = block_.lanes[lane];
      const double away_deg =
          base::distance_bearing(forth ? begin : end, forth ? end : begin).bearing_deg;
      const LatLon past = along(forth ? end : begin, base::yaw_from_heading(away_deg), kPastEnd_m);
      row.until = {past.lat, past.lon, std::nullopt};
    }
    out_.items.emplace_back(row);
  }

  /// From lane to lane, or back into the same one, as far out as the border asks for.
  /// @param lanes to the side where row 2 lies. @param next where the next lane lies, to turn there
  void change(int lane, int lanes, int next, bool forth) {
    const LaneLeft left{lane, forth, (block_.turn == Side::Right) == forth};
    // On the way back the next row lies on the other hand.
    const bool right = left.grows_right == (next > 0);
    LaneChange c;
    c.aside_m = (right ? 1.0 : -1.0) * std::abs(lanes) * block_.spacing_m;
    c.hand = right ? Side::Right : Side::Left;
    c.out_m = block_.out_m;
    c.kind = block_.turn_kind;
    c.radius_m = radius_m(std::abs(c.aside_m));
    std::vector<Item> items;
    change_lane(c, kind_of(c, vehicle_), items);
    const std::vector<TurnPoint> way = way_of(items);
    const double farther_m = centimetres(ends_.farther_m(left, way, block_.out_m));
    c.out_m += farther_m;
    const double far_m = change_lane(c, kind_of(c, vehicle_), out_.items);
    const double up_m = centimetres(farther_m - ends_.beyond_m(left, lane + lanes));
    if (up_m > kNear_m) out_.items.emplace_back(Move{up_m});
    if (std::max(c.out_m, up_m) > kFarthestOut_m) too_slanted(lane, lane + lanes, c.out_m, up_m);
    const bool lies = !block_.lanes.empty();
    const double deep_m = lies ? centimetres(ends_.deepest_m(left, way, farther_m)) : far_m;
    out_.headland_m = std::max(out_.headland_m, deep_m);
  }

  static double centimetres(double value_m) { return std::round(value_m * 100.0) / 100.0; }

  void too_slanted(int from, int to, double out_m, double up_m) {
    wrong_.push_back({"/block", "has too slanted a border: from row " + std::to_string(from) +
                                    " to row " + std::to_string(to) + " nothing is seen for " +
                                    tenths_up(std::max(out_m, up_m)) + " m; at most " +
                                    fixed_number(kFarthestOut_m, 1) + " m are driven so"});
  }

  const RowBlock& block_;
  const TurningVehicle& vehicle_;
  const bool steered_;
  const LaneEnds ends_;
  std::vector<base::FieldError> wrong_;
  PlannedRows out_;
};

}  // namespace

std::vector<int> order_of(const RowBlock& block) {
  std::vector<int> out;
  for (int pass = 0; pass <= block.skip; ++pass) {
    for (int row = pass; row < block.rows; row += block.skip + 1) out.push_back(row + 1);
  }
  return out;
}

base::Result<PlannedRows> plan_rows(const RowBlock& block, const TurningVehicle& vehicle) {
  return RowsPlanner(block, vehicle).plan();
}

}  // namespace roverd::mission
