#pragma once
// What changed between two revisions of a mission. Pure, any thread.

#include <cstddef>
#include <optional>
#include <vector>

#include "mission/plan.hpp"

namespace roverd::mission {

enum class ItemChange { Added, Removed, Changed };
std::string_view to_string(ItemChange change) noexcept;  // added removed changed

struct ItemDifference {
  ItemChange change = ItemChange::Changed;
  std::optional<int> before;      ///< number in the older plan; empty: added
  std::optional<int> now;         ///< number in the newer plan; empty: removed
  std::optional<double> moved_m;  ///< of a waypoint that stands elsewhere
};

struct Differences {
  bool name = false;
  bool home = false;
  bool settings = false;
  bool frame = false;
  std::size_t added = 0;
  std::size_t removed = 0;
  std::size_t changed = 0;
  std::size_t unchanged = 0;
  /// In the order of the plans; at most kMaxDifferences, the counts have all.
  std::vector<ItemDifference> items;
};

inline constexpr std::size_t kMaxDifferences = 1000;

/// Items are matched in order, with as few differences as there can be; where that would take too
/// long (thousands of items changed in both), what stands between the first and the last difference
/// is matched by place. A jump that leads to the same item under a new number counts as changed.
Differences compare(const Plan& before, const Plan& now);

}  // namespace roverd::mission
