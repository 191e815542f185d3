// Blocks of rows with slanted borders: no turn leads through the plants of another row.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"
#include "mission/rows/block.hpp"
#include "mission/rows/lies.hpp"

namespace roverd::mission {
namespace {

constexpr double kSpacing_m = 2.5;
constexpr double kLength_m = 30.0;
const base::TangentPlane kGroundPlane(LatLon{58.0, 26.0});

/// Row 1 leads north from 0 to kLength_m, the others lie to its right. Each border goes on so far
/// to the north for each metre to the east.
RowBlock slanted(int rows, double near_slope, double far_slope) {
  const double wide_m = (rows - 1) * kSpacing_m;
  const auto at = [](double east_m, double north_m) {
    return kGroundPlane.to_global({east_m, north_m});
  };
  const auto laid =
      lay_rows({{at(0.0, 0.0), at(0.0, kLength_m), at(wide_m, kLength_m + far_slope * wide_m),
                 at(wide_m, near_slope * wide_m)},
                kSpacing_m,
                rows,
                {}});
  EXPECT_TRUE(laid) << laid.error().detail;
  RowBlock block;
  block.rows = rows;
  block.spacing_m = kSpacing_m;
  block.turn = laid->turn;
  block.heading_deg = laid->heading_deg;
  block.entry = laid->lanes.front()[0];
  block.lanes = laid->lanes;
  return block;
}

/// What the items drive, in metres east and north: rows to where they end, the rest as it is told.
class Drive {
 public:
  Drive(const RowBlock& block, const std::vector<Item>& items) {
    for (const auto& [begin, end] : block.lanes) {
      const auto from = kGroundPlane.to_local(begin);
      lanes_.push_back({from.east_m, from.north_m, kGroundPlane.to_local(end).north_m});
    }
    at_ = {lanes_[0].east_m, lanes_[0].begin_m};
    for (const Item& item : items) {
      if (std::holds_alternative<Row>(item)) row();
      if (const auto* move = std::get_if<Move>(&item)) go(move->forward_m, 0.0);
      if (const auto* turn = std::get_if<TurnBy>(&item); turn && turn->turn_deg) {
        const double by_rad = base::rad_from_deg(*turn->turn_deg);
        go(turn->radius_m.value_or(0.0) * std::abs(by_rad), by_rad);
      }
    }
  }

  std::vector<int> driven;  ///< lanes, from 1
  double inside_m = 0.0;    ///< so deep a turn leads into a lane's end
  double farthest_m = 0.0;  ///< from where a lane is looked for to its beginning
  double nearest_m = 1e9;   ///< likewise
  double beside_m = 0.0;    ///< it is entered beside its middle
  double deepest_m = 0.0;   ///< beyond the end of the lane beside it

 private:
  struct Lane {
    double east_m = 0.0;
    double begin_m = 0.0;
    double end_m = 0.0;
  };

  const Lane& lane_here() const {
    const double number = std::round(at_.east_m / kSpacing_m);
    return lanes_[static_cast<std::size_t>(
        std::clamp(number, 0.0, static_cast<double>(lanes_.size() - 1)))];
  }
  void row() {
    const Lane& lane = lane_here();
    const bool north = std::cos(heading_rad_) > 0.0;
    const double before_m = north ? lane.begin_m - at_.north_m : at_.north_m - lane.end_m;
    if (!driven.empty()) {
      farthest_m = std::max(farthest_m, before_m);
      nearest_m = std::min(nearest_m, before_m);
    }
    beside_m = std::max(beside_m, std::abs(at_.east_m - lane.east_m));
    driven.push_back(static_cast<int>(std::lround(lane.east_m / kSpacing_m)) + 1);
    at_ = {lane.east_m, north ? lane.end_m : lane.begin_m};
  }
  void go(double way_m, double turn_rad) {
    constexpr int kPieces = 2000;
    for (int i = 0; i < kPieces; ++i) {
      heading_rad_ += turn_rad / (2.0 * kPieces);
      at_.east_m += way_m / kPieces * std::sin(heading_rad_);
      at_.north_m += way_m / kPieces * std::cos(heading_rad_);
      heading_rad_ += turn_rad / (2.0 * kPieces);
      look();
    }
  }
  void look() {
    const Lane& lane = lane_here();
    const double out_m = std::max(at_.north_m - lane.end_m, lane.begin_m - at_.north_m);
    deepest_m = std::max(deepest_m, out_m);
    if (std::abs(at_.east_m - lane.east_m) < 0.5 * kSpacing_m)
      inside_m = std::max(inside_m, -out_m);
  }

  std::vector<Lane> lanes_;
  base::EnuPoint at_;
  double heading_rad_ = 0.0;  ///< clockwise from north
};

constexpr TurningVehicle kTurnsAnywhere{};
constexpr TurningVehicle kSteered{2.0, false};

//      ╱│            the next row reaches 2.5 m beyond this one at one end, and begins
//    ╱│ │            2.5 m behind it at the other
//  │ 2│ 3
//  1  │╱
//  │ ╱
TEST(RowBorders, LetNoTurnLeadThroughThePlantsOfAnotherRow) {
  for (const TurningVehicle& vehicle : {kTurnsAnywhere, kSteered}) {
    for (const RowTurn kind : {RowTurn::Auto, RowTurn::Omega, RowTurn::Shunt}) {
      for (const double slope : {-1.0, -0.4, 0.0, 0.4, 1.0}) {
        for (const int skip : {0, 1}) {
          for (const bool alternating : {true, false}) {
            if (skip > 0 && std::abs(slope) > 0.5) continue;  // refused: below
            SCOPED_TRACE(std::to_string(vehicle.narrowest_m) + ' ' + std::string(to_string(kind)) +
                         " slope " + std::to_string(slope) + " skip " + std::to_string(skip) +
                         (alternating ? "" : " one way"));
            // Given a block of which the far border is slanted,
            RowBlock block = slanted(5, 0.0, slope);
            block.turn_kind = kind;
            block.radius_m = kind == RowTurn::Auto ? std::nullopt : std::optional(2.2);
            block.skip = skip;
            block.alternating = alternating;
            // when it is planned and driven,
            const auto planned = plan_rows(block, vehicle);
            ASSERT_TRUE(planned) << planned.error().detail;
            const Drive drive(block, planned->items);
            // then every lane is entered from before its beginning, and none crossed.
            std::vector<int> once = drive.driven;
            once.erase(std::unique(once.begin(), once.end()), once.end());
            EXPECT_EQ(once, order_of(block));
            EXPECT_LT(drive.inside_m, 0.01);
            EXPECT_LT(drive.farthest_m, block.out_m + 0.35);
            EXPECT_GT(drive.nearest_m, block.out_m - 0.05);
            EXPECT_LT(drive.beside_m, 0.01);
            EXPECT_NEAR(planned->headland_m, drive.deepest_m, 0.05);
          }
        }
      }
    }
  }
}

TEST(RowBorders, SlantedAtBothEndsLeadOutAndBackByAsMuch) {
  const auto planned = plan_rows(slanted(3, 1.0, 1.0), kTurnsAnywhere);
  ASSERT_TRUE(planned);
  std::vector<double> moves_m;
  for (const Item& item : planned->items) {
    if (const auto* move = std::get_if<Move>(&item)) moves_m.push_back(move->forward_m);
  }
  // Out as far as row 2 reaches, across; out of row 2, across, up to where row 3 begins; and away.
  const std::vector<double> expected{4.0, 2.5, 1.5, 2.5, 2.5, 1.5};
  ASSERT_EQ(moves_m.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(moves_m[i], expected[i], 0.03) << i;
  }
}

TEST(RowBorders, AreRefusedWhereTheyLeadFartherThanAnythingIsSeen) {
  for (const double slope : {-3.0, 3.0}) {
    const auto refused = plan_rows(slanted(3, 0.0, slope), kTurnsAnywhere);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().fields.at(0).pointer, "/block");
    EXPECT_NE(refused.error().detail.find("from row 1 to row 2"), std::string::npos)
        << refused.error().detail;
  }
}

}  // namespace
}  // namespace roverd::mission
