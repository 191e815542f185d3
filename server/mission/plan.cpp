#include "mission/plan.hpp"

#include <array>

namespace roverd::mission {

std::string_view type_name(const Item& item) noexcept {
  // In the order of the variant.
  static constexpr std::array<std::string_view, std::variant_size_v<Item>> kNames{
      "waypoint", "local", "move",      "turn", "wait",        "speed",
      "row",      "wall",  "landmarks", "jump", "return_home", "action"};
  return item.valueless_by_exception() ? std::string_view{} : kNames[item.index()];
}

double length_m(const Plan& plan) noexcept {
  double sum_m = 0.0;
  const Waypoint* before = nullptr;
  for (const Item& item : plan.items) {
    const auto* waypoint = std::get_if<Waypoint>(&item);
    if (waypoint == nullptr) continue;
    if (before != nullptr) sum_m += base::distance_bearing(before->at, waypoint->at).distance_m;
    before = waypoint;
  }
  return sum_m;
}

}  // namespace roverd::mission
