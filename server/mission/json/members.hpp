#pragma once
// Visitors for the lists in fields.hpp: one checks values in memory, one reads them out of JSON.
// Both note what is wrong by JSON pointer.

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "mission/json/fields.hpp"
#include "mission/json/pointer.hpp"
#include "mission/text.hpp"

namespace roverd::mission {

/// "must be one of left right"
template <class E>
std::string words_problem() {
  std::string text = "must be one of";
  for (const E word : kWordsOf<E>) text += ' ' + std::string(to_string(word));
  return text;
}

inline constexpr std::string_view kTwoOfOne =
    "and turn_deg exclude each other: give one of the two";

/// A place in a document: "/home", or "/items" and 3. Its text is only made when it is needed.
struct Place {
  std::string_view name;
  std::optional<std::size_t> index{};
  std::string text() const {
    std::string out(name);
    if (index) out += '/' + std::to_string(*index);
    return out;
  }
};

/// Checks the values of a struct in memory.
class Checker {
 public:
  Checker(Place where, Problems& problems) : where_(where), problems_(problems) {}

  void number(std::string_view name, const double& value, const Range& range) {
    if (!range.holds(value)) add(name, range_problem(range, value));
  }
  void number(std::string_view name, const std::optional<double>& value, const Range& range) {
    if (value) number(name, *value, range);
  }
  void whole(std::string_view name, const int& value, int min, int max) {
    number(name, double{static_cast<double>(value)}, {double(min), double(max)});
  }
  void count(std::string_view name, const int& value, int max) { whole(name, value, 0, max); }
  void count(std::string_view name, const std::optional<int>& value, int max) {
    if (value) whole(name, *value, 0, max);
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
  void rest(const nlohmann::json& value) {
    if (!value.is_object() || value.contains("type") || value.contains("name")) {
      problems_.add(where_.text(), "arguments must be an object without type and name");
    }
  }
  void exactly_one(std::string_view a, bool has_a, std::string_view b, bool has_b) {
    if (has_a && has_b) add(b, std::string(kTwoOfOne));
    if (!has_a && !has_b) add(a, "or " + std::string(b) + " is required");
  }

 private:
  void add(std::string_view name, std::string detail) {
    problems_.add(where_.text() + '/' + std::string(name), std::move(detail));
  }

  const Place where_;
  Problems& problems_;
};

/// Fills a struct from an object.
class MemberReader {
 public:
  MemberReader(const nlohmann::json& object, Place where, Problems& problems)
      : object_(object), where_(where), problems_(problems) {}

  void number(std::string_view name, double& out, const Range& range) {
    if (const nlohmann::json* value = required(name)) read(name, *value, out, range);
  }
  void number(std::string_view name, std::optional<double>& out, const Range& range) {
    if (const nlohmann::json* value = present(name)) read(name, *value, out.emplace(), range);
  }
  void whole(std::string_view name, int& out, int min, int max) {
    if (const nlohmann::json* value = required(name)) read_whole(name, *value, out, min, max);
  }
  void count(std::string_view name, int& out, int max) {
    if (const nlohmann::json* value = required(name)) read_count(name, *value, out, max);
  }
  void count(std::string_view name, std::optional<int>& out, int max) {
    if (const nlohmann::json* value = present(name)) read_count(name, *value, out.emplace(), max);
  }
  void flag(std::string_view name, bool& out) {
    const nlohmann::json* value = present(name);
    if (value == nullptr) return;
    if (value->is_boolean()) {
      out = value->get<bool>();
    } else {
      add(name, "must be true or false");
    }
  }
  template <class E>
  void word(std::string_view name, E& out) {
    if (const nlohmann::json* value = required(name)) read_word(name, *value, out);
  }
  template <class E>
  void word_or(std::string_view name, E& out, E usual) {
    out = usual;
    if (const nlohmann::json* value = present(name)) read_word(name, *value, out);
  }
  void name(std::string_view name, std::string& out) {
    const nlohmann::json* value = required(name);
    if (value == nullptr) return;
    if (!value->is_string()) return add(name, "must be text");
    out = value->get_ref<const std::string&>();
    if (std::string problem = name_problem(out); !problem.empty()) add(name, problem);
  }
  void rest(nlohmann::json& out) {
    out = nlohmann::json::object();
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
  const nlohmann::json* known(std::string_view name) {
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
    problems_.add(where_.text() + '/' + escaped_key(name), std::move(detail));
  }

 private:
  const nlohmann::json* present(std::string_view name) {
    const nlohmann::json* value = known(name);
    return value == nullptr || value->is_null() ? nullptr : value;
  }
  const nlohmann::json* required(std::string_view name) {
    const nlohmann::json* value = known(name);
    if (value == nullptr) add(name, "is required");
    return value;
  }
  bool read(std::string_view name, const nlohmann::json& value, double& out, const Range& range) {
    if (!value.is_number()) {
      add(name, "must be a number");
      return false;
    }
    out = value.get<double>();
    if (range.holds(out)) return true;
    add(name, range_problem(range, out));
    return false;
  }
  void read_whole(std::string_view name, const nlohmann::json& value, int& out, int min, int max) {
    double number = 0.0;
    if (!read(name, value, number, {double(min), double(max)})) return;
    if (std::nearbyint(number) != number) {
      add(name, "must be a whole number");
    } else {
      out = static_cast<int>(number);
    }
  }
  void read_count(std::string_view name, const nlohmann::json& value, int& out, int max) {
    if (!value.is_string()) return read_whole(name, value, out, 0, max);
    out = 0;
    if (value != "forever") add(name, "must be a number of times, or \"forever\" (0)");
  }
  template <class E>
  void read_word(std::string_view name, const nlohmann::json& value, E& out) {
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

  const nlohmann::json& object_;
  const Place where_;
  Problems& problems_;
  std::array<std::string_view, 16> known_{};  // the largest item has nine members
  std::size_t known_count_ = 0;
  bool all_known_ = false;
};

}  // namespace roverd::mission
