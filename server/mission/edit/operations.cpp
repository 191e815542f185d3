#include "mission/edit/operations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mission/edit/operation_steps.hpp"
#include "mission/json/json.hpp"
#include "mission/text.hpp"

namespace roverd::mission {

using base::Code;
using base::Error;
using base::Result;

Result<Done> perform(Plan plan, const Operation& operation) {
  const auto items = plan.drawing.is_null() ? std::vector<Item>() : plan.items;
  auto done = std::visit([&](const auto& step) { return apply(std::move(plan), step); }, operation);
  if (!done) return done;
  // Other points are not what was drawn.
  if (!done->plan.drawing.is_null() && done->plan.items != items) done->plan.drawing = nullptr;
  if (done->plan.items.size() > kMaxItems) {
    return base::fail(Code::Invalid,
                      "the mission would have " + std::to_string(done->plan.items.size()) +
                          " items, at most " + std::to_string(kMaxItems) + " are possible");
  }
  if (auto ok = check_plan(done->plan); !ok) {
    Error error = std::move(ok.error());
    error.detail = "this would make the mission impossible: " + error.detail;
    return tl::unexpected<Error>(std::move(error));
  }
  return done;
}

Error wrong(const std::string& pointer, const std::string& detail) {
  return {Code::Invalid, pointer.substr(1) + " " + detail, {{pointer, detail}}};
}

Result<Numbers> numbers_in(const Plan& plan, const std::optional<Numbers>& which) {
  const int count = static_cast<int>(plan.items.size());
  if (!which) return Numbers{1, count};
  const bool one = which->first == which->last;
  for (const auto& [pointer, number] : {std::pair{one ? "/item" : "/first", which->first},
                                        {one ? "/item" : "/last", which->last}}) {
    if (number < 1 || number > count) {
      return tl::unexpected<Error>(wrong(pointer, count == 0 ? "cannot be: the mission has no items"
                                                             : "must be from 1 to " +
                                                                   std::to_string(count) + ", is " +
                                                                   std::to_string(number)));
    }
  }
  if (which->first > which->last) {
    return tl::unexpected<Error>(wrong("/last", "must not be less than first"));
  }
  return *which;
}

void lead_jumps(std::vector<Item>& items, const std::vector<int>& new_number) {
  for (Item& item : items) {
    auto* jump = std::get_if<Jump>(&item);
    if (jump == nullptr || jump->item < 1) continue;
    const auto old = static_cast<std::size_t>(jump->item) - 1;
    if (old < new_number.size()) jump->item = new_number[old];
  }
}

int take_out(std::vector<Item>& items, std::vector<bool> gone) {
  int jumps = 0;
  std::vector<int> new_number(items.size());
  for (bool settled = false; !settled;) {
    settled = true;
    int kept = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
      new_number[i] = kept + 1;  // of the one that comes in its place, if it goes
      if (!gone[i]) ++kept;
    }
    for (int& number : new_number) number = std::min(number, std::max(kept, 1));
    for (std::size_t i = 0; i < items.size(); ++i) {
      const auto* jump = std::get_if<Jump>(&items[i]);
      if (jump == nullptr || gone[i] || jump->item < 1) continue;
      const auto target = static_cast<std::size_t>(jump->item) - 1;
      if (target >= items.size() || new_number[target] != new_number[i]) continue;
      gone[i] = true;  // it would lead to itself
      ++jumps;
      settled = false;
    }
  }
  lead_jumps(items, new_number);
  std::size_t to = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (gone[i]) continue;
    if (to != i) items[to] = std::move(items[i]);
    ++to;
  }
  items.resize(to);
  return jumps;
}

std::vector<bool> jump_targets(const Plan& plan) {
  std::vector<bool> out(plan.items.size(), false);
  for (const Item& item : plan.items) {
    const auto* jump = std::get_if<Jump>(&item);
    if (jump == nullptr || jump->item < 1) continue;
    if (static_cast<std::size_t>(jump->item) <= out.size()) {
      out[static_cast<std::size_t>(jump->item) - 1] = true;
    }
  }
  return out;
}

std::string words_of(const Plan& plan, const Numbers& which) {
  if (which.first == 1 && which.last == static_cast<int>(plan.items.size())) return "all items";
  if (which.first == which.last) return "item " + std::to_string(which.first);
  return "items " + std::to_string(which.first) + " to " + std::to_string(which.last);
}

std::string counted(std::size_t count, const char* one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

std::string rounded_text(double value) {
  constexpr double kSteps = 1000.0;
  const double rounded = std::round(value * kSteps) / kSteps;
  return number_text(rounded == 0.0 ? 0.0 : rounded);
}

}  // namespace roverd::mission
