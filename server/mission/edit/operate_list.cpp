// Operations on the list of items: add, remove, clear, reverse, join, split, renumber; and home.

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include "mission/edit/operation_steps.hpp"
#include "mission/json/json.hpp"
#include "mission/text.hpp"

namespace roverd::mission {

using base::Error;
using base::Result;

namespace {

std::string with_jumps(std::string what, int jumps) {
  if (jumps > 0) what += " and " + counted(static_cast<std::size_t>(jumps), "jump") + " to it";
  return what;
}

bool counts_from_map(const Plan& plan) noexcept {
  return std::any_of(plan.items.begin(), plan.items.end(),
                     [](const Item& item) { return std::holds_alternative<MapPoint>(item); });
}

}  // namespace

Result<Done> apply(Plan plan, const AddWaypoint& add) {
  const int count = static_cast<int>(plan.items.size());
  if (plan.items.size() >= kMaxItems) {
    return base::fail(base::Code::Conflict, "the mission is full");
  }
  const int after = add.after.value_or(count);
  if (after < 0 || after > count) {
    return tl::unexpected<Error>(wrong(
        "/after", "must be from 0 to " + std::to_string(count) + ", is " + std::to_string(after)));
  }
  std::vector<int> new_number(plan.items.size());
  std::iota(new_number.begin(), new_number.begin() + after, 1);
  std::iota(new_number.begin() + after, new_number.end(), after + 2);
  lead_jumps(plan.items, new_number);
  plan.items.insert(plan.items.begin() + after, add.waypoint);
  return Done{std::move(plan), "added waypoint " + std::to_string(after + 1), after + 1, {}};
}

Result<Done> apply(Plan plan, const RemoveItems& remove) {
  const int last = static_cast<int>(plan.items.size());
  const auto which = numbers_in(plan, remove.which.value_or(Numbers{last, last}));
  if (!which) return tl::unexpected<Error>(which.error());
  std::string what = "removed " + words_of(plan, *which);
  std::vector<bool> gone(plan.items.size(), false);
  std::fill(gone.begin() + which->first - 1, gone.begin() + which->last, true);
  const int jumps = take_out(plan.items, std::move(gone));
  return Done{std::move(plan), with_jumps(std::move(what), jumps), which->first, {}};
}

Result<Done> apply(Plan plan, const Clear& clear) {
  std::string what = "cleared: " + counted(plan.items.size(), "item");
  plan.items.clear();
  if (clear.home) {
    plan.home = clear.home;
    what += ", home set";
  }
  return Done{std::move(plan), std::move(what), std::nullopt, {}};
}

Result<Done> apply(Plan plan, const Reverse&) {
  std::vector<int> new_number(plan.items.size());
  std::iota(new_number.rbegin(), new_number.rend(), 1);
  lead_jumps(plan.items, new_number);
  std::reverse(plan.items.begin(), plan.items.end());
  for (Item& item : plan.items) {
    if (auto* circle = std::get_if<Circle>(&item)) circle->clockwise = !circle->clockwise;
  }
  return Done{std::move(plan), "reversed", std::nullopt, {}};
}

Result<Done> apply(Plan plan, const SetHome& set) {
  plan.home = set.home;
  return Done{std::move(plan),
              "set home to " + number_text(set.home.at.lat) + ", " + number_text(set.home.at.lon),
              std::nullopt,
              {}};
}

Result<Done> apply(Plan plan, const Join& join) {
  const int before = static_cast<int>(plan.items.size());
  if (plan.items.size() + join.other.items.size() > kMaxItems) {
    return tl::unexpected<Error>(
        wrong("/mission_id", "has " + std::to_string(join.other.items.size()) +
                                 " items: together more than " + std::to_string(kMaxItems)));
  }
  // A mission counts from one map: the other's metres would mean other places on this one.
  const auto& theirs = join.other.frame;
  if (counts_from_map(join.other) && plan.frame && theirs && *plan.frame != *theirs) {
    return tl::unexpected<Error>(wrong("/mission_id", "counts from the map \"" + theirs->map +
                                                          "\", this mission from \"" +
                                                          plan.frame->map + "\""));
  }
  if (!plan.frame) plan.frame = theirs;
  if (!plan.frame) plan.frame = join.other.frame;
  plan.items.reserve(plan.items.size() + join.other.items.size());
  for (const Item& item : join.other.items) {
    plan.items.push_back(item);
    if (auto* jump = std::get_if<Jump>(&plan.items.back())) jump->item += before;
  }
  std::string what =
      "joined " + counted(join.other.items.size(), "item") + " of \"" + join.other.name + "\"";
  return Done{std::move(plan), std::move(what), std::nullopt, {}};
}

Result<Done> apply(Plan plan, const Renumber& renumber) {
  const auto which = numbers_in(plan, renumber.which);
  if (!which) return tl::unexpected<Error>(which.error());
  const int many = which->last - which->first + 1;
  const int most = static_cast<int>(plan.items.size()) - many + 1;
  if (renumber.to < 1 || renumber.to > most) {
    return tl::unexpected<Error>(wrong("/to", "must be from 1 to " + std::to_string(most) +
                                                  ", is " + std::to_string(renumber.to)));
  }
  std::string what = "made " + words_of(plan, *which) + (many == 1 ? " item " : " begin at item ") +
                     std::to_string(renumber.to);
  std::vector<int> order(plan.items.size());  // by new place the old number
  std::iota(order.begin(), order.end(), 1);
  const auto first = order.begin() + which->first - 1;
  const auto end = order.begin() + which->last;
  if (renumber.to < which->first) {
    std::rotate(order.begin() + renumber.to - 1, first, end);
  } else {
    std::rotate(first, end, order.begin() + renumber.to - 1 + many);
  }
  std::vector<int> new_number(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    new_number[static_cast<std::size_t>(order[i]) - 1] = static_cast<int>(i) + 1;
  }
  lead_jumps(plan.items, new_number);
  std::vector<Item> items;
  items.reserve(order.size());
  for (const int old : order) {
    items.push_back(std::move(plan.items[static_cast<std::size_t>(old) - 1]));
  }
  plan.items = std::move(items);
  return Done{std::move(plan), std::move(what), std::nullopt, {}};
}

Result<Parts> split(Plan plan, int after, bool shared) {
  const int count = static_cast<int>(plan.items.size());
  if (after < 1 || after >= count) {
    return tl::unexpected<Error>(
        wrong("/after", count < 2 ? std::string("cannot be: the mission has too few items")
                                  : "must be from 1 to " + std::to_string(count - 1) + ", is " +
                                        std::to_string(after)));
  }
  const int skipped = shared ? after - 1 : after;
  Parts parts;
  parts.rest.name = name_with_ending(plan.name, " (2)");
  parts.rest.home = plan.home;
  parts.rest.settings = plan.settings;
  parts.rest.frame = plan.frame;
  for (int i = 0; i < count; ++i) {
    const auto* jump = std::get_if<Jump>(&plan.items[static_cast<std::size_t>(i)]);
    if (jump == nullptr) continue;
    const bool in_first = i < after;
    const bool fits = in_first ? jump->item <= after : jump->item > skipped;
    if (!fits || (shared && i == after - 1)) {
      return tl::unexpected<Error>(
          wrong("/after", "cannot be: the jump that is item " + std::to_string(i + 1) +
                              " leads to item " + std::to_string(jump->item) + ", across the cut"));
    }
  }
  for (int i = skipped; i < count; ++i) {
    parts.rest.items.push_back(plan.items[static_cast<std::size_t>(i)]);
    if (auto* jump = std::get_if<Jump>(&parts.rest.items.back())) jump->item -= skipped;
  }
  plan.items.resize(static_cast<std::size_t>(after));
  parts.first = std::move(plan);
  parts.first.drawing = nullptr;
  return parts;
}

}  // namespace roverd::mission
