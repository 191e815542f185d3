// JSON values to plans, and the check of plans made in memory: both by the lists in fields.hpp.

#include <algorithm>
#include <cmath>
#include <utility>

#include "mission/fields.hpp"
#include "mission/json.hpp"
#include "mission/pointer.hpp"
#include "mission/text.hpp"

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

template <class E>
std::string words_problem() {
  std::string text = "must be one of";
  for (const E word : kWordsOf<E>) text += ' ' + std::string(to_string(word));
  return text;
}

constexpr std::string_view kTwoOfOne = "and turn_deg exclude each other: give one of the two";

/// Checks the values of a struct in memory.
class Checker {
 public:
  Checker(const std::string& where, Problems& problems) : where_(where), problems_(problems) {}

  void number(std::string_view name, const double& value, const Range& range) {
    if (!range.holds(value)) add(name, range_problem(range, value));
  }
  void number(std::string_view name, const std::optional<double>& value, const Range& range) {
    if (value) number(name, *value, range);
  }
  void whole(std::string_view name, const int& value, int min, int max) {
    number(name, double{static_cast<double>(value)}, {double(min), double(max)});
  }
  void flag(std::string_view, const bool&) {}
  template <class E>
  void word(std::string_view name, const E& value) {
    const auto& words = kWordsOf<E>;
    if (std::find(words.begin(), words.end(), value) == words.end()) add(name, words_problem<E>());
  }
  template <class E>
  void word_or(std::string_view name, const E& value, E) {
    word(name, value);
  }
  void name(std::string_view name, const std::string& value) {
    if (std::string problem = name_problem(value); !problem.empty()) add(name, problem);
  }
  void rest(const json& value) {
    if (!value.is_object() || value.contains("type") || value.contains("name")) {
      problems_.add(where_, "arguments must be an object without type and name");
    }
  }
  void exactly_one(std::string_view a, bool has_a, std::string_view b, bool has_b) {
    if (has_a && has_b) add(b, std::string(kTwoOfOne));
    if (!has_a && !has_b) add(a, "or " + std::string(b) + " is required");
  }

 private:
  void add(std::string_view name, std::string detail) {
    problems_.add(where_ + '/' + std::string(name), std::move(detail));
  }

  const std::string& where_;
  Problems& problems_;
};

/// Fills a struct from an object. The pointer's text is only made when something is wrong.
class ItemReader {
 public:
  ItemReader(const json& object, std::string where, Problems& problems)
      : object_(object), where_(std::move(where)), problems_(problems) {}

  void number(std::string_view name, double& out, const Range& range) {
    if (const json* value = required(name)) read(name, *value, out, range);
  }
  void number(std::string_view name, std::optional<double>& out, const Range& range) {
    if (const json* value = present(name)) read(name, *value, out.emplace(), range);
  }
  void whole(std::string_view name, int& out, int min, int max) {
    const json* value = required(name);
    double number = 0.0;
    if (value == nullptr || !read(name, *value, number, {double(min), double(max)})) return;
    if (std::nearbyint(number) != number) {
      add(name, "must be a whole number");
    } else {
      out = static_cast<int>(number);
    }
  }
  void flag(std::string_view name, bool& out) {
    const json* value = present(name);
    if (value == nullptr) return;
    if (value->is_boolean()) {
      out = value->get<bool>();
    } else {
      add(name, "must be true or false");
    }
  }
  template <class E>
  void word(std::string_view name, E& out) {
    if (const json* value = required(name)) read_word(name, *value, out);
  }
  template <class E>
  void word_or(std::string_view name, E& out, E usual) {
    out = usual;
    if (const json* value = present(name)) read_word(name, *value, out);
  }
  void name(std::string_view name, std::string& out) {
    const json* value = required(name);
    if (value == nullptr) return;
    if (!value->is_string()) return add(name, "must be text");
    out = value->get_ref<const std::string&>();
    if (std::string problem = name_problem(out); !problem.empty()) add(name, problem);
  }
  void rest(json& out) {
    out = json::object();
    for (const auto& [key, value] : object_.items()) {
      if (!is_known(key)) out.emplace(key, value);
    }
    all_known_ = true;
  }
  void exactly_one(std::string_view a, bool has_a, std::string_view b, bool has_b) {
    if (has_a && has_b) add(b, std::string(kTwoOfOne));
    if (!has_a && !has_b && present(a) == nullptr && present(b) == nullptr) {
      add(a, "or " + std::string(b) + " is required");
    }
  }

  /// The member as it is, even null; it counts as known from then on.
  const json* known(std::string_view name) {
    known_[std::min(known_count_++, known_.size() - 1)] = name;
    const auto at = object_.find(name);
    return at == object_.end() ? nullptr : &*at;
  }
  /// After all members were asked for.
  void refuse_unknown() {
    if (all_known_) return;
    for (const auto& [key, value] : object_.items()) {
      if (!is_known(key)) add(key, "is not a known member");
    }
  }
  void add(std::string_view name, std::string detail) {
    problems_.add(where_ + '/' + escaped_key(name), std::move(detail));
  }

 private:
  const json* present(std::string_view name) {
    const json* value = known(name);
    return value == nullptr || value->is_null() ? nullptr : value;
  }
  const json* required(std::string_view name) {
    const json* value = known(name);
    if (value == nullptr) add(name, "is required");
    return value;
  }
  bool read(std::string_view name, const json& value, double& out, const Range& range) {
    if (!value.is_number()) {
      add(name, "must be a number");
      return false;
    }
    out = value.get<double>();
    if (range.holds(out)) return true;
    add(name, range_problem(range, out));
    return false;
  }
  template <class E>
  void read_word(std::string_view name, const json& value, E& out) {
    if (value.is_string()) {
      for (const E word : kWordsOf<E>) {
        if (to_string(word) == value.get_ref<const std::string&>()) {
          out = word;
          return;
        }
      }
    }
    add(name, words_problem<E>());
  }
  bool is_known(std::string_view key) const {
    const auto end = known_.begin() + static_cast<std::ptrdiff_t>(known_count_);
    return std::find(known_.begin(), end, key) != end;
  }

  const json& object_;
  const std::string where_;
  Problems& problems_;
  std::array<std::string_view, 16> known_{};  // the largest item has nine members
  std::size_t known_count_ = 0;
  bool all_known_ = false;
};

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

Item read_item(const json& value, const std::string& where, Problems& problems) {
  Item item;
  if (!value.is_object()) {
    problems.add(where, "must be an object");
    return item;
  }
  ItemReader reader(value, where, problems);
  const json* type = reader.known("type");
  if (type == nullptr) {
    reader.add("type", "is required");
  } else if (!type->is_string() ||
             !emplace_type(item, type->get_ref<const std::string&>(), kAllTypes)) {
    reader.add("type", types_problem(kAllTypes));
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
  ItemReader reader(value, where, problems);
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
  ItemReader reader(value, "", problems);
  reader.name("name", plan.name);
  if (const json* home = reader.known("home"); home != nullptr && !home->is_null()) {
    read_object(*home, "/home", plan.home.emplace(), problems);
  }
  if (const json* settings = reader.known("settings");
      settings != nullptr && !settings->is_null()) {
    read_object(*settings, "/settings", plan.settings, problems);
  }
  const json* items = reader.known("items");
  if (items == nullptr) {
    reader.add("items", "is required");
  } else if (!items->is_array()) {
    reader.add("items", "must be a list");
  } else if (items->size() > kMaxItems) {
    return tl::unexpected<Error>(too_many(items->size()));
  } else {
    plan.items.reserve(items->size());
    for (std::size_t i = 0; i < items->size(); ++i) {
      plan.items.push_back(read_item((*items)[i], "/items/" + std::to_string(i), problems));
    }
    check_jumps(plan, problems);
  }
  reader.refuse_unknown();
  if (problems.none()) return plan;
  return tl::unexpected<Error>(std::move(problems).error("the mission"));
}

Result<Plan> plan_from_text(std::string_view text) {
  auto value = parse_json(text);
  if (!value) return tl::unexpected<Error>(std::move(value).error());
  return plan_from_json(*value);
}

Result<Item> item_from_json(const json& value, const std::string& pointer) {
  Problems problems;
  Item item = read_item(value, pointer, problems);
  if (problems.none()) return item;
  return tl::unexpected<Error>(std::move(problems).error("the item"));
}

Result<void> check_plan(const Plan& plan) {
  if (plan.items.size() > kMaxItems) return tl::unexpected<Error>(too_many(plan.items.size()));
  Problems problems;
  Checker(std::string(), problems).name("name", plan.name);
  const auto check = [&problems](const std::string& where, const auto& members) {
    Checker checker(where, problems);
    fields(checker, members);
  };
  if (plan.home) check("/home", *plan.home);
  check("/settings", plan.settings);
  for (std::size_t i = 0; i < plan.items.size(); ++i) {
    const std::string where = "/items/" + std::to_string(i);
    std::visit([&](const auto& members) { check(where, members); }, plan.items[i]);
  }
  check_jumps(plan, problems);
  if (problems.none()) return {};
  return tl::unexpected<Error>(std::move(problems).error("the mission"));
}

}  // namespace roverd::mission
