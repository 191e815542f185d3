#pragma once
// Parameters. A struct lists its fields once, in a free function found by ADL:
//
//   template <class V> void fields(V& v, TrackParams& p) {
//     v("lookahead_min_m", p.lookahead_min_m, 0.2, 20.0, "shorter is livelier, may weave");
//     v("pivot_enabled", p.pivot_enabled, "turn on the spot at sharp corners");
//   }
//
// That list loads and range-checks (set), and prints the documentation (describe). The unit is the
// name's suffix. What keeps people safe says so in its sentence, with the side that is stricter:
//
//   v("base_timeout_s", p.base_timeout_s, 0.1, 2.0, base::lower_is_stricter("no word: stop"));

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

/// Which change of a parameter makes the robot no less safe.
enum class Stricter {
  Any,     ///< it is no safety parameter
  Lower,   ///< a smaller number
  Higher,  ///< a larger number, or true
  None     ///< no change is: geometry, words
};

/// A parameter's sentence for people, and what it has to do with safety.
struct Sentence {
  // Not explicit: most have nothing to do with it.
  constexpr Sentence(const char* for_people, Stricter side = Stricter::Any) noexcept
      : text(for_people), stricter(side) {}
  constexpr operator std::string_view() const noexcept { return text; }
  std::string_view text;
  Stricter stricter;
};
constexpr Sentence lower_is_stricter(const char* text) noexcept {
  return {text, Stricter::Lower};
}
constexpr Sentence higher_is_stricter(const char* text) noexcept {
  return {text, Stricter::Higher};
}
constexpr Sentence only_disarmed(const char* text) noexcept {
  return {text, Stricter::None};
}

struct ParamInfo {
  std::string name;
  ParamValue value;
  std::optional<double> min;
  std::optional<double> max;
  bool integer = false;
  std::string description;
  Stricter stricter = Stricter::Any;
};

/// Is this a step to the stricter side, or none? Numbers that are not finite are no step to it.
inline bool keeps_safe(Stricter side, const ParamValue& from, const ParamValue& to) noexcept {
  if (side == Stricter::Any || from == to) return true;
  const auto number = [](const ParamValue& value) -> std::optional<double> {
    if (const bool* flag = std::get_if<bool>(&value)) return *flag ? 1.0 : 0.0;
    const double* given = std::get_if<double>(&value);
    return given != nullptr ? std::optional(*given) : std::nullopt;
  };
  const auto before = number(from);
  const auto after = number(to);
  if (!before || !after) return false;
  return (side == Stricter::Lower && *after <= *before) ||
         (side == Stricter::Higher && *after >= *before);
}

namespace detail {

struct Describe {
  std::vector<ParamInfo> out;

  template <class N>
  void operator()(std::string_view name, N& field, double min, double max, Sentence says) {
    out.push_back({std::string(name), static_cast<double>(field), min, max, std::is_integral_v<N>,
                   std::string(says.text), says.stricter});
  }
  void operator()(std::string_view name, bool& field, Sentence says) {
    out.push_back({std::string(name), field, std::nullopt, std::nullopt, false,
                   std::string(says.text), says.stricter});
  }
  void operator()(std::string_view name, std::string& field, Sentence says) {
    out.push_back({std::string(name), field, std::nullopt, std::nullopt, false,
                   std::string(says.text), says.stricter});
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
