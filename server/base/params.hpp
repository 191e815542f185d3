#pragma once
// Parameters. A struct lists its fields once, in a free function found by ADL:
//
//   template <class V> void fields(V& v, TrackParams& p) {
//     v("lookahead_min_m", p.lookahead_min_m, 0.2, 20.0, "shorter is livelier, may weave");
//     v("pivot_enabled", p.pivot_enabled, "turn on the spot at sharp corners");
//   }
//
// That list loads and range-checks (set), and prints the documentation (describe). The unit is the
// name's suffix.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/result.hpp"

namespace roverd::base {

using ParamValue = std::variant<bool, double, std::string>;

struct ParamInfo {
  std::string name;
  ParamValue value;
  std::optional<double> min;
  std::optional<double> max;
  bool integer = false;
  std::string description;
};

namespace detail {

struct Describe {
  std::vector<ParamInfo> out;

  template <class N>
  void operator()(std::string_view name, N& field, double min, double max, std::string_view text) {
    out.push_back({std::string(name), static_cast<double>(field), min, max, std::is_integral_v<N>,
                   std::string(text)});
  }
  void operator()(std::string_view name, bool& field, std::string_view text) {
    out.push_back({std::string(name), field, std::nullopt, std::nullopt, false, std::string(text)});
  }
  void operator()(std::string_view name, std::string& field, std::string_view text) {
    out.push_back({std::string(name), field, std::nullopt, std::nullopt, false, std::string(text)});
  }
};

struct Set {
  std::string_view wanted;
  const ParamValue& value;
  bool found = false;
  std::string problem{};

  template <class N>
  void operator()(std::string_view name, N& field, double min, double max, std::string_view) {
    if (name != wanted) return;
    found = true;
    const double* number = std::get_if<double>(&value);
    if (number == nullptr) {
      problem = "must be a number";
    } else if (!(*number >= min && *number <= max)) {
      problem = "must lie in " + text(min) + " .. " + text(max);
    } else if (std::is_integral_v<N> && std::nearbyint(*number) != *number) {
      problem = "must be a whole number";
    } else {
      field = static_cast<N>(*number);
    }
  }
  void operator()(std::string_view name, bool& field, std::string_view) {
    if (name != wanted) return;
    found = true;
    if (const bool* flag = std::get_if<bool>(&value)) {
      field = *flag;
    } else {
      problem = "must be true or false";
    }
  }
  void operator()(std::string_view name, std::string& field, std::string_view) {
    if (name != wanted) return;
    found = true;
    if (const auto* word = std::get_if<std::string>(&value)) {
      field = *word;
    } else {
      problem = "must be text";
    }
  }

  static std::string text(double number) {
    std::string s = std::to_string(number);
    s.erase(std::max(s.find_last_not_of('0'), s.find('.') + 1) + 1);
    return s;
  }
};

}  // namespace detail

/// Every field with its present value (of a default-made struct: its default), in listed order.
template <class P>
std::vector<ParamInfo> describe(P params) {
  detail::Describe visitor;
  fields(visitor, params);
  return visitor.out;
}

/// Sets one field. Unknown name, wrong type or out of range: an error naming it, nothing changed.
template <class P>
Result<void> set_param(P& params, std::string_view name, const ParamValue& value) {
  detail::Set visitor{name, value};
  fields(visitor, params);
  if (!visitor.found) {
    return fail(Code::Invalid, "unknown key", {{std::string(name), "unknown key"}});
  }
  if (!visitor.problem.empty()) {
    return fail(Code::Invalid, std::string(name) + " " + visitor.problem,
                {{std::string(name), visitor.problem}});
  }
  return {};
}

}  // namespace roverd::base
