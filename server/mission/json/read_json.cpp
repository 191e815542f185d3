// JSON values to plans, and the check of plans made in memory: both by the lists in fields.hpp.

#include <algorithm>
#include <cmath>
#include <utility>

#include "mission/json/checker.hpp"
#include "mission/json/json.hpp"
#include "mission/json/quick_read.hpp"

namespace roverd::mission {

std::string range_problem(const Range& range, double value) {
  std::string text = "must be ";
  if (range.without_min || range.without_max) {
    text += range.without_min ? "more than " : "at least ";
    text += number_text(range.min);
    text += range.without_max ? " and less than " : " and at most ";
  } else {
    text += "from " + number_text(range.min) + " to ";
  }
  text += number_text(range.max) + ", is ";
  if (std::isnan(value)) return text + "not a number";
  return text + (std::isinf(value) ? std::string("infinite") : number_text(value));
}

namespace {

using base::Code;
using base::Error;
using base::Result;
using nlohmann::json;

template <std::size_t... I>
bool emplace_type(Item& item, std::string_view word, std::index_sequence<I...>) {
  return ((type_name(Item(std::in_place_index<I>)) == word &&
           (static_cast<void>(item.emplace<I>()), true)) ||
          ...);
}

constexpr auto kAllTypes = std::make_index_sequence<std::variant_size_v<Item>>{};

template <std::size_t... I>
std::string types_problem(std::index_sequence<I...>) {
  std::string text = "must be one of";
  ((text += ' ' + std::string(type_name(Item(std::in_place_index<I>)))), ...);
  return text;
}

Item read_item(const json& value, Place where, Problems& problems) {
  Item item;
  if (!value.is_object()) {
    problems.add(where.text(), "must be an object");
    return item;
  }
  Members reader(value, where, problems);
  const json* type = reader.known("type");
  if (type == nullptr) {
    reader.complain("type", "is required");
  } else if (!type->is_string() ||
             !emplace_type(item, type->get_ref<const std::string&>(), kAllTypes)) {
    reader.complain("type", types_problem(kAllTypes));
  } else {
    std::visit([&](auto& members) { fields(reader, members); }, item);
    reader.refuse_unknown();
  }
  return item;
}

template <class T>
void read_object(const json& value, const char* where, T& out, Problems& problems) {
  if (!value.is_object()) {
    problems.add(where, "must be an object");
    return;
  }
  Members reader(value, Place{where}, problems);
  fields(reader, out);
  reader.refuse_unknown();
}

/// What an item may only be inside a whole plan.
void check_jumps(const Plan& plan, Problems& problems) {
  for (std::size_t i = 0; i < plan.items.size(); ++i) {
    const auto* jump = std::get_if<Jump>(&plan.items[i]);
    if (jump == nullptr || jump->item < 1) continue;  // below 1 is reported already
    const std::string where = "/items/" + std::to_string(i) + "/item";
    if (static_cast<std::size_t>(jump->item) == i + 1) {
      problems.add(where, "must not be the jump itself");
    } else if (static_cast<std::size_t>(jump->item) > plan.items.size()) {
      problems.add(where, "must be from 1 to " + std::to_string(plan.items.size()) + ", is " +
                              std::to_string(jump->item));
    }
  }
}

/// Likewise: what counts from a map needs to know from which one.
void check_map_points(const Plan& plan, Problems& problems) {
  if (plan.frame) return;
  for (std::size_t i = 0; i < plan.items.size(); ++i) {
    if (!std::holds_alternative<MapPoint>(plan.items[i])) continue;
    problems.add("/items/" + std::to_string(i),
                 "counts from a map: the mission needs a frame {map: its name}");
  }
}

/// What is wrong with a drawing that is one; empty: nothing.
std::string drawing_problem(const json& drawing) {
  if (!drawing.is_object()) return "must be an object";
  const auto kind = drawing.find("kind");
  const auto word = kind != drawing.end() && kind->is_string()
                        ? std::string_view(kind->get_ref<const std::string&>())
                        : std::string_view();
  const bool fits = !word.empty() && word.size() <= kMaxDrawingKind &&
                    std::all_of(word.begin(), word.end(), [](char c) {
                      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
                    });
  if (!fits) {
    return "must have a kind: a word of at most " + std::to_string(kMaxDrawingKind) +
           " of a-z, 0-9 and _";
  }
  const std::size_t bytes = drawing.dump(-1, ' ', false, json::error_handler_t::replace).size();
  if (bytes <= kMaxDrawing) return {};
  return "takes " + std::to_string(bytes) + " bytes as text, at most " +
         std::to_string(kMaxDrawing) + " are possible";
}

Error too_many(std::size_t count) {
  std::string detail =
      "has " + std::to_string(count) + ", at most " + std::to_string(kMaxItems) + " are possible";
  return {Code::TooLarge, "/items " + detail, {{"/items", detail}}};
}

}  // namespace

Result<Plan> plan_from_json(const json& value) {
  Problems problems;
  Plan plan;
  if (!value.is_object()) {
    problems.add("", "must be an object");
    return tl::unexpected<Error>(std::move(problems).error("the mission"));
  }
  Members reader(value, Place{}, problems);
  reader.name("name", plan.name);
  if (const json* home = reader.known("home"); home != nullptr && !home->is_null()) {
    read_object(*home, "/home", plan.home.emplace(), problems);
  }
  if (const json* settings = reader.known("settings");
      settings != nullptr && !settings->is_null()) {
    read_object(*settings, "/settings", plan.settings, problems);
  }
  if (const json* frame = reader.known("frame"); frame != nullptr && !frame->is_null()) {
    read_object(*frame, "/frame", plan.frame.emplace(), problems);
  }
  if (const json* drawing = reader.known("drawing"); drawing != nullptr && !drawing->is_null()) {
    const std::string wrong = drawing_problem(*drawing);
    if (!wrong.empty()) problems.add("/drawing", wrong);
    plan.drawing = *drawing;
  }
  const json* items = reader.known("items");
  if (items == nullptr) {
    reader.complain("items", "is required");
  } else if (!items->is_array()) {
    reader.complain("items", "must be a list");
  } else if (items->size() > kMaxItems) {
    return tl::unexpected<Error>(too_many(items->size()));
  } else {
    plan.items.reserve(items->size());
    for (std::size_t i = 0; i < items->size(); ++i) {
      plan.items.push_back(read_item((*items)[i], Place{"/items", i}, problems));
    }
    check_jumps(plan, problems);
    check_map_points(plan, problems);
  }
  reader.refuse_unknown();
  if (problems.none()) return plan;
  return tl::unexpected<Error>(std::move(problems).error("the mission"));
}

Result<Plan> plan_from_text(std::string_view text) {
  if (auto plan = quick_plan(text)) return std::move(*plan);
  auto value = parse_json(text);
  if (!value) return tl::unexpected<Error>(std::move(value).error());
  return plan_from_json(*value);
}

Result<Item> item_from_json(const json& value, const std::string& pointer) {
  Problems problems;
  Item item = read_item(value, Place{pointer}, problems);
  if (problems.none()) return item;
  return tl::unexpected<Error>(std::move(problems).error("the item"));
}

Result<void> check_plan(const Plan& plan) {
  if (plan.items.size() > kMaxItems) return tl::unexpected<Error>(too_many(plan.items.size()));
  Problems problems;
  Checker(Place{}, problems).name("name", plan.name);
  const auto check = [&problems](Place where, const auto& members) {
    Checker checker(where, problems);
    fields(checker, members);
  };
  if (plan.home) check({"/home"}, *plan.home);
  check({"/settings"}, plan.settings);
  if (plan.frame) check({"/frame"}, *plan.frame);
  if (!plan.drawing.is_null()) {
    if (const std::string wrong = drawing_problem(plan.drawing); !wrong.empty()) {
      problems.add("/drawing", wrong);
    }
  }
  for (std::size_t i = 0; i < plan.items.size(); ++i) {
    std::visit([&](const auto& members) { check({"/items", i}, members); }, plan.items[i]);
  }
  check_jumps(plan, problems);
  check_map_points(plan, problems);
  if (problems.none()) return {};
  return tl::unexpected<Error>(std::move(problems).error("the mission"));
}

}  // namespace roverd::mission
