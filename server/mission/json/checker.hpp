#pragma once
// The visitor of fields.hpp that checks values in memory. (Members, in object.hpp, reads them out
// of JSON.) What is wrong is noted by JSON pointer.

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "mission/json/fields.hpp"
#include "mission/json/object.hpp"
#include "mission/text.hpp"

namespace roverd::mission {

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
  void word(std::string_view name, const std::optional<E>& value) {
    if (value) word(name, *value);
  }
  template <class E>
  void word_or(std::string_view name, const E& value, E) {
    word(name, value);
  }
  void name(std::string_view name, const std::string& value) {
    if (std::string problem = name_problem(value); !problem.empty()) add(name, problem);
  }
  void name(std::string_view at, const std::optional<std::string>& value) {
    if (value) name(at, *value);
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
  void together(std::string_view a, bool has_a, std::string_view b, bool has_b) {
    if (has_a != has_b) add(has_a ? b : a, "is required where the other one is given");
  }

 private:
  void add(std::string_view name, std::string detail) {
    problems_.add(where_.text() + '/' + std::string(name), std::move(detail));
  }

  const Place where_;
  Problems& problems_;
};

}  // namespace roverd::mission
