// Blocks of rows: where the robot would be is counted along the items.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "mission/rows/block.hpp"

namespace roverd::mission {
namespace {

constexpr TurningVehicle kTracked{};
constexpr TurningVehicle kCar{3.0, false};

/// Where a row is entered: along row 1 from its beginning, to its left, and pointing.
struct Entered {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
};

/// Row items lead from end to end of rows that reach from 0 to `length_m`.
class Walk {
 public:
  explicit Walk(const std::vector<Item>& items, double length_m = 20.0) : length_m_(length_m) {
    for (const Item& item : items) {
      if (const auto* turn = std::get_if<TurnBy>(&item)) this->turn(*turn);
      if (const auto* move = std::get_if<Move>(&item)) go(move->forward_m);
      if (std::holds_alternative<Row>(item)) row();
    }
  }

  std::vector<Entered> entered;
  double farthest_m = 0.0;  ///< beyond the rows' ends
  double narrowest_m = 1e9;
  bool pivots = false;

 private:
  void turn(const TurnBy& t) {
    const double by_rad = -base::rad_from_deg(t.turn_deg.value_or(0.0));
    if (!t.radius_m) {
      pivots = true;
      yaw_ += by_rad;
      return;
    }
    narrowest_m = std::min(narrowest_m, *t.radius_m);
    for (int i = 0; i < 1000; ++i) {
      yaw_ += by_rad / 2000.0;
      go(*t.radius_m * std::abs(by_rad) / 1000.0);
      yaw_ += by_rad / 2000.0;
    }
  }
  void row() {
    entered.push_back({x_, y_, base::wrap_rad(yaw_)});
    x_ = std::cos(yaw_) > 0.0 ? length_m_ : 0.0;
  }
  void go(double by_m) {
    x_ += by_m * std::cos(yaw_);
    y_ += by_m * std::sin(yaw_);
    farthest_m = std::max({farthest_m, x_ - length_m_, -x_});
  }

  double length_m_;
  double x_ = 0.0;
  double y_ = 0.0;
  double yaw_ = 0.0;
};

RowBlock rows_of(int rows, double spacing_m) {
  RowBlock block;
  block.rows = rows;
  block.spacing_m = spacing_m;
  return block;
}

std::string pointers(const base::Result<PlannedRows>& refused) {
  EXPECT_FALSE(refused);
  std::string out;
  if (refused) return out;
  for (const auto& field : refused.error().fields) out += field.pointer + ' ';
  return out;
}

TEST(RowBlocks, DriveEveryRowOnceThereAndBack) {
  const RowBlock block = rows_of(3, 2.5);
  const auto planned = plan_rows(block, kTracked);
  ASSERT_TRUE(planned);
  const Walk walk(planned->items);
  ASSERT_EQ(walk.entered.size(), 3U);
  EXPECT_NEAR(walk.entered[1].y_m, -2.5, 1e-6);  // to the right of the first
  EXPECT_NEAR(walk.entered[2].y_m, -5.0, 1e-6);
  EXPECT_NEAR(walk.entered[1].x_m, 21.5, 1e-6);  // from the other end
  EXPECT_NEAR(walk.entered[2].x_m, -1.5, 1e-6);
  EXPECT_EQ(planned->items.size(), 3U * 2U + 2U * 3U);
  EXPECT_EQ(planned->headland_m, block.out_m);
}

TEST(RowBlocks, LeaveRowsOutAndComeBackForThem) {
  RowBlock block = rows_of(5, 2.5);
  block.skip = 1;
  block.turn = Side::Left;
  EXPECT_EQ(order_of(block), (std::vector<int>{1, 3, 5, 2, 4}));
  const Walk walk(plan_rows(block, kTracked)->items);
  ASSERT_EQ(walk.entered.size(), 5U);
  const double expected[] = {0.0, 5.0, 10.0, 2.5, 7.5};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(walk.entered[i].y_m, expected[i], 1e-6) << i;
}

// Whatever the turn: into the next lane at its end, and along it.
TEST(RowBlocks, ComeIntoTheNextLaneByEveryKindOfTurn) {
  for (const RowTurn kind : {RowTurn::Arc, RowTurn::Omega, RowTurn::Shunt}) {
    for (const Side side : {Side::Left, Side::Right}) {
      for (const double spacing_m : {2.5, 6.0, 8.0}) {
        if (kind == RowTurn::Arc && spacing_m < 6.0) continue;
        RowBlock block = rows_of(4, spacing_m);
        block.turn = side;
        block.turn_kind = kind;
        block.radius_m = 3.0;
        const auto planned = plan_rows(block, kCar);
        ASSERT_TRUE(planned) << planned.error().detail;
        const Walk walk(planned->items);
        ASSERT_EQ(walk.entered.size(), 4U);
        EXPECT_FALSE(walk.pivots);
        EXPECT_EQ(walk.narrowest_m, 3.0);
        EXPECT_NEAR(walk.farthest_m, planned->headland_m, 0.01);
        const double left = side == Side::Left ? 1.0 : -1.0;
        for (int i = 0; i < 4; ++i) {
          const Entered& in = walk.entered[std::size_t(i)];
          const bool back = i % 2 == 1;
          const double before_m = i == 0 ? 0.0 : 1.5;
          EXPECT_NEAR(in.y_m, left * i * spacing_m, 1e-3) << to_string(kind) << i;
          EXPECT_NEAR(in.x_m, back ? 20.0 + before_m : -before_m, 1e-3) << to_string(kind) << i;
          EXPECT_NEAR(std::abs(in.yaw_rad), back ? base::kPi : 0.0, 1e-6) << to_string(kind) << i;
        }
      }
    }
  }
}

TEST(RowBlocks, NeedNoMoreHeadlandByAShuntThanItsArc) {
  RowBlock block = rows_of(2, 2.5);
  block.radius_m = 3.0;
  block.turn_kind = RowTurn::Shunt;
  EXPECT_NEAR(plan_rows(block, kCar)->headland_m, 1.5 + 3.0, 1e-9);
  block.turn_kind = RowTurn::Omega;
  // cos 45.1 deg = (3 + 1.25) / 6: two swings of 3 m high up to the middle circle, and its radius.
  EXPECT_NEAR(plan_rows(block, kCar)->headland_m, 1.5 + 4.235 + 3.0, 0.01);
}

TEST(RowBlocks, TurnAsSuitsTheVehicleWhereNobodySaysHow) {
  EXPECT_TRUE(Walk(plan_rows(rows_of(2, 2.5), kTracked)->items).pivots);
  const Walk car(plan_rows(rows_of(2, 2.5), kCar)->items);
  EXPECT_FALSE(car.pivots);
  EXPECT_NEAR(car.narrowest_m, 3.3, 0.1001);  // with some steering left
  // Wide lanes need no shunt: nothing leads backwards.
  const auto wide = plan_rows(rows_of(2, 8.0), kCar);
  for (const Item& item : wide->items) {
    const auto* move = std::get_if<Move>(&item);
    if (move != nullptr) {
      EXPECT_GT(move->forward_m, 0.0);
    }
  }
  // One that turns anyhow goes round in one half circle.
  RowBlock round = rows_of(2, 2.5);
  round.turn_kind = RowTurn::Arc;
  const auto planned = plan_rows(round, kTracked);
  ASSERT_TRUE(planned);
  EXPECT_EQ(planned->items.at(2), Item(TurnBy{180.0, std::nullopt, 1.25}));
}

// A few centimetres more than two radii apart: one half circle that is so much wider.
TEST(RowBlocks, DoNotStopBetweenTwoArcsForALittleWay) {
  RowBlock block = rows_of(2, 6.08);
  block.radius_m = 3.0;
  const auto planned = plan_rows(block, kCar);
  ASSERT_TRUE(planned);
  EXPECT_EQ(planned->items.at(2), Item(TurnBy{180.0, std::nullopt, 3.04}));
  EXPECT_NEAR(planned->headland_m, 1.5 + 3.04, 1e-9);
}

TEST(RowBlocks, EnterAllRowsAtTheSameEndWhereTheyDoNotAlternate) {
  for (const TurningVehicle& vehicle : {kTracked, kCar}) {
    RowBlock block = rows_of(3, 2.5);
    block.alternating = false;
    const auto planned = plan_rows(block, vehicle);
    ASSERT_TRUE(planned);
    const Walk walk(planned->items);
    // Forth and back in each lane, but the last one.
    ASSERT_EQ(walk.entered.size(), 5U);
    const double lanes[] = {0.0, 0.0, -2.5, -2.5, -5.0};
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_NEAR(walk.entered[i].y_m, lanes[i], 1e-3) << i;
      EXPECT_NEAR(std::abs(walk.entered[i].yaw_rad), i % 2 == 0 ? 0.0 : base::kPi, 1e-6) << i;
    }
  }
}

TEST(RowBlocks, BeginAtTheirEntry) {
  RowBlock block;
  block.entry = LatLon{58.0, 26.0};
  block.heading_deg = 30.0;
  const auto items = plan_rows(block, kTracked)->items;
  EXPECT_TRUE(std::holds_alternative<Waypoint>(items.at(0)));
  EXPECT_EQ(items.at(1), Item(TurnBy{std::nullopt, 30.0}));
}

// A car comes along the row, since it cannot turn at its entry.
TEST(RowBlocks, BeginOnAStraightWithACar) {
  RowBlock block;
  block.entry = LatLon{58.0, 26.0};
  block.heading_deg = 30.0;
  const auto items = plan_rows(block, kCar)->items;
  const auto& before = std::get<Waypoint>(items.at(0));
  const auto& entry = std::get<Waypoint>(items.at(1));
  const auto way = base::distance_bearing(before.at, entry.at);
  EXPECT_EQ(entry.at, *block.entry);
  EXPECT_NEAR(way.bearing_deg, 30.0, 0.01);
  EXPECT_GT(way.distance_m, kCar.narrowest_m);
  EXPECT_TRUE(std::holds_alternative<Row>(items.at(2)));
}

TEST(RowBlocks, EndAtTheLatestBehindWhereTheyLie) {
  RowBlock block = rows_of(2, 2.5);
  const LatLon begin{58.0, 26.0};
  const LatLon end{58.0, 26.001};
  block.lanes = {{begin, end}, {begin, end}};
  const auto items = plan_rows(block, kTracked)->items;
  std::vector<Row> rows;
  for (const Item& item : items) {
    if (const auto* row = std::get_if<Row>(&item)) rows.push_back(*row);
  }
  ASSERT_EQ(rows.size(), 2U);
  const auto past = [](const Row& row, LatLon from) {
    return base::distance_bearing(from, {row.until.lat.value(), row.until.lon.value()});
  };
  EXPECT_NEAR(past(rows[0], end).distance_m, kPastEnd_m, 0.01);
  EXPECT_NEAR(past(rows[0], end).bearing_deg, 90.0, 0.1);
  EXPECT_NEAR(past(rows[1], begin).distance_m, kPastEnd_m, 0.01);
  EXPECT_NEAR(past(rows[1], begin).bearing_deg, 270.0, 0.1);  // that one is driven back
}

TEST(RowBlocks, NameWhatIsWrong) {
  RowBlock block;
  block.rows = 0;
  block.spacing_m = std::nan("");
  block.skip = -1;
  block.out_m = 6.5;  // the next row would not be seen from there
  block.radius_m = -1.0;
  block.entry = LatLon{91.0, 0.0};
  EXPECT_EQ(pointers(plan_rows(block, kTracked)),
            "/rows /spacing_m /skip /out_m /radius_m /entry /heading_deg ");
}

TEST(RowBlocks, RefuseToLeaveOutMoreLanesThanThereAre) {
  RowBlock block = rows_of(3, 2.5);
  block.skip = 20;
  const auto planned = plan_rows(block, kTracked);
  EXPECT_EQ(pointers(planned), "/skip ");
  EXPECT_NE(planned.error().detail.find("less than rows"), std::string::npos);
  block.skip = 3;
  EXPECT_EQ(pointers(plan_rows(block, kTracked)), "/skip ");
  block.skip = 2;
  EXPECT_TRUE(plan_rows(block, kTracked));
}

TEST(RowBlocks, NameWhatThisVehicleCannotDrive) {
  RowBlock block = rows_of(2, 2.5);
  block.turn_kind = RowTurn::Pivot;
  EXPECT_EQ(pointers(plan_rows(block, kCar)), "/turn_kind ");
  block.turn_kind = RowTurn::Shunt;
  block.radius_m = 2.9;
  const auto narrow = plan_rows(block, kCar);
  EXPECT_EQ(pointers(narrow), "/radius_m ");
  EXPECT_NE(narrow.error().detail.find("at least 3.0"), std::string::npos) << narrow.error().detail;
  block.turn_kind = RowTurn::Arc;
  block.radius_m = 3.0;
  const auto near = plan_rows(block, kCar);
  EXPECT_EQ(pointers(near), "/turn_kind ");
  EXPECT_NE(near.error().detail.find("6.0 m apart"), std::string::npos) << near.error().detail;
  block.skip = 1;  // nor does it help, with two rows
  EXPECT_EQ(pointers(plan_rows(block, kCar)), "/turn_kind ");
  block.turn_kind = RowTurn::Omega;
  block.radius_m.reset();
  EXPECT_EQ(pointers(plan_rows(block, kTracked)), "/radius_m ");
  block.radius_m = 2.0;  // it would turn on the spot whatever is said
  block.turn_kind = RowTurn::Auto;
  EXPECT_EQ(pointers(plan_rows(block, kTracked)), "/radius_m ");
  EXPECT_TRUE(plan_rows(block, {1.5, false})) << "a car drives arcs";
  block.radius_m.reset();
  EXPECT_EQ(pointers(plan_rows(rows_of(2, 2.5), {3.0, true})), "/rows ");  // a trailer
  RowBlock turned = rows_of(2, 2.5);
  turned.heading_deg = 30.0;
  EXPECT_EQ(pointers(plan_rows(turned, kCar)), "/heading_deg ");
  block = rows_of(2, 8.0);
  block.turn_kind = RowTurn::Arc;
  block.alternating = false;
  EXPECT_EQ(pointers(plan_rows(block, kCar)), "/turn_kind ");
}

}  // namespace
}  // namespace roverd::mission
