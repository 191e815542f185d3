// Blocks of rows: where the robot would be is counted along the items.

#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "mission/rows/block.hpp"

namespace roverd::mission {
namespace {

/// Row items are `length_m` long and the next one begins where the last move out of it ended.
std::vector<std::pair<double, double>> rows_driven(const std::vector<Item>& items,
                                                   double length_m) {
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;
  std::vector<std::pair<double, double>> begins;
  bool first = true;
  for (const Item& item : items) {
    double go_m = 0.0;
    if (const auto* turn = std::get_if<TurnBy>(&item)) yaw -= base::rad_from_deg(*turn->turn_deg);
    if (const auto* move = std::get_if<Move>(&item)) go_m = move->forward_m;
    if (std::holds_alternative<Row>(item)) {
      begins.emplace_back(std::round(x), y);
      go_m = first ? length_m : length_m + 1.5;  // out of the one before, into this one
      first = false;
    }
    x += go_m * std::cos(yaw);
    y += go_m * std::sin(yaw);
  }
  return begins;
}

TEST(RowBlocks, DriveEveryRowOnceThereAndBack) {
  RowBlock block;
  block.rows = 3;
  block.spacing_m = 2.5;
  const auto items = plan_rows(block);
  ASSERT_TRUE(items);
  const auto begins = rows_driven(*items, 20.0);
  ASSERT_EQ(begins.size(), 3U);
  EXPECT_NEAR(begins[1].second, -2.5, 1e-6);  // to the right of the first
  EXPECT_NEAR(begins[2].second, -5.0, 1e-6);
  EXPECT_GT(begins[1].first, 20.0);  // from the other end
  EXPECT_LT(begins[2].first, 0.0);
  EXPECT_EQ(items->size(), 3U * 2U + 2U * 3U);
}

TEST(RowBlocks, LeaveRowsOutAndComeBackForThem) {
  RowBlock block;
  block.rows = 5;
  block.skip = 1;
  block.turn = Side::Left;
  EXPECT_EQ(order_of(block), (std::vector<int>{1, 3, 5, 2, 4}));
  const auto begins = rows_driven(*plan_rows(block), 20.0);
  ASSERT_EQ(begins.size(), 5U);
  const double expected[] = {0.0, 5.0, 10.0, 2.5, 7.5};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(begins[i].second, expected[i], 1e-6) << i;
}

TEST(RowBlocks, BeginAtTheirEntry) {
  RowBlock block;
  block.entry = LatLon{58.0, 26.0};
  block.heading_deg = 30.0;
  const auto items = plan_rows(block);
  ASSERT_TRUE(items);
  EXPECT_TRUE(std::holds_alternative<Waypoint>(items->at(0)));
  EXPECT_EQ(items->at(1), Item(TurnBy{std::nullopt, 30.0}));
}

TEST(RowBlocks, NameWhatIsWrong) {
  RowBlock block;
  block.rows = 0;
  block.spacing_m = std::nan("");
  block.skip = -1;
  block.out_m = 6.5;  // the next row would not be seen from there
  block.entry = LatLon{91.0, 0.0};
  const auto refused = plan_rows(block);
  ASSERT_FALSE(refused);
  std::vector<std::string> at;
  for (const auto& f : refused.error().fields) at.push_back(f.pointer);
  EXPECT_EQ(at, (std::vector<std::string>{"/rows", "/spacing_m", "/skip", "/out_m", "/entry",
                                          "/heading_deg"}));
}

}  // namespace
}  // namespace roverd::mission
