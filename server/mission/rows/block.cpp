#include "mission/rows/block.hpp"

#include <cmath>
#include <cstdlib>
#include <string>

namespace roverd::mission {
namespace {

base::Result<void> check_block(const RowBlock& b) {
  std::vector<base::FieldError> wrong;
  const auto within = [&](const char* at, double value, double least, double most,
                          const char* words) {
    if (!(value >= least && value <= most)) wrong.push_back({at, words});
  };
  within("/rows", b.rows, 1, kMostRows, "must be from 1 to 1000");
  within("/spacing_m", b.spacing_m, 0.3, 50.0, "must be from 0.3 to 50");
  within("/skip", b.skip, 0, 20, "must be from 0 to 20");
  within("/out_m", b.out_m, 0.1, kFarthestOut_m,
         "must be from 0.1 to 6: farther off the next row is not seen");
  if (b.entry && !base::is_valid(*b.entry)) wrong.push_back({"/entry", "is no place on earth"});
  if (b.entry && !b.heading_deg) wrong.push_back({"/heading_deg", "is needed with an entry"});
  if (b.heading_deg)
    within("/heading_deg", *b.heading_deg, 0.0, 359.999999, "must be from 0 to 360");
  if (wrong.empty()) return {};
  return base::fail(base::Code::Invalid, wrong[0].pointer + " " + wrong[0].detail, wrong);
}

}  // namespace

std::vector<int> order_of(const RowBlock& block) {
  std::vector<int> out;
  for (int pass = 0; pass <= block.skip; ++pass) {
    for (int row = pass; row < block.rows; row += block.skip + 1) out.push_back(row + 1);
  }
  return out;
}

base::Result<std::vector<Item>> plan_rows(const RowBlock& block) {
  if (auto good = check_block(block); !good) return tl::unexpected<base::Error>(good.error());
  std::vector<Item> items;
  if (block.entry) {
    Waypoint entry;
    entry.at = *block.entry;
    items.emplace_back(entry);
  }
  if (block.heading_deg) items.emplace_back(TurnBy{std::nullopt, block.heading_deg});
  const std::vector<int> order = order_of(block);
  const double right_deg = block.turn == Side::Right ? 90.0 : -90.0;
  bool forth = true;
  for (std::size_t i = 0; i < order.size(); ++i) {
    items.emplace_back(block.row);
    items.emplace_back(Move{block.out_m});
    if (i + 1 == order.size()) break;
    const int aside = order[i + 1] - order[i];
    // On the way back the next row lies on the other hand.
    const double turn_deg = (aside > 0) == forth ? right_deg : -right_deg;
    items.emplace_back(TurnBy{turn_deg, std::nullopt});
    items.emplace_back(Move{std::abs(aside) * block.spacing_m});
    items.emplace_back(TurnBy{turn_deg, std::nullopt});
    forth = !forth;
  }
  return items;
}

}  // namespace roverd::mission
