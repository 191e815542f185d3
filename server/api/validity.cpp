#include "api/validity.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <optional>

#include "api/problem.hpp"

namespace roverd::api {

namespace {

constexpr const char* kSeen = "Roverd-Seen";
/// Two clocks, and one that is told in coarse steps.
constexpr double kAhead_s = 0.25;
constexpr const char* kSeenRule =
    "must be the robot's monotonic seconds, as mono_s tells them, and not in the future";

std::optional<double> seconds_of(std::string_view text) noexcept {
  double value = 0.0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = ec == std::errc{} && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Empty: that time cannot have been seen.
std::optional<base::Time> seen_at(double seen_s, base::Time now) noexcept {
  const double now_s = base::seconds(now.time_since_epoch());
  if (!(seen_s >= 0.0 && seen_s <= now_s + kAhead_s)) return std::nullopt;
  return std::min(now, base::Time{} + base::from_seconds(seen_s));
}

/// By the header; empty: there is none, or one that was complained of.
std::optional<base::Time> seen_by(const Call& call, Members& members) {
  const auto given = call.request.equal_range(kSeen);
  if (given.first == given.second) return std::nullopt;
  const auto value = given.first->value();
  const auto seen_s = seconds_of({value.data(), value.size()});
  const auto seen = seen_s ? seen_at(*seen_s, base::steady_now()) : std::nullopt;
  if (!seen) members.complain_of_header(kSeen, kSeenRule);
  if (std::next(given.first) != given.second) {
    members.complain_of_header(kSeen, "is given more than once");
  }
  return seen;
}

}  // namespace

double mono_s(base::Time now) noexcept {
  return std::floor(base::seconds(now.time_since_epoch()) * 1e3) / 1e3;
}

robot::Validity validity_of(Members& members, const Call& call, Moves moves) {
  if (moves == Moves::No) {
    (void)members.any("valid_for_s");  // nothing that it says can be in a stop's way
    return base::Time::max();
  }
  const double good_s = members.number("valid_for_s", 0.0, kLongestValid_s).value_or(kClickValid_s);
  const base::Time seen = seen_by(call, members).value_or(call.begun);
  return {seen + base::from_seconds(good_s), seen};
}

robot::Validity stick_validity_of(const StreamAge& age) {
  const double good_s =
      age.inner.number("valid_for_s", 0.0, kLongestValid_s).value_or(kStickValid_s);
  base::Time from = age.begun;
  for (Members* where : {&age.outer, &age.inner}) {
    const auto seen_s = where->number("seen_s", 0.0, 1e12);
    if (!seen_s) continue;
    const auto seen = seen_at(*seen_s, base::steady_now());
    if (!seen) where->complain("seen_s", kSeenRule);
    from = seen.value_or(from);
  }
  return {from + base::from_seconds(good_s), from};
}

base::Error late_error(base::Time not_after, base::Time now) {
  char by[32];
  std::snprintf(by, sizeof by, "%.2f s ", base::seconds(now - not_after));
  return {base::Code::Late,
          std::string("the command arrived ") + by + "too late and was not carried out",
          {}};
}

bool refused_as_late(const CallPtr& call, const robot::Validity& validity) {
  const base::Time now = base::steady_now();
  if (now <= validity.not_after) return false;
  call->respond(problem(late_error(validity.not_after, now)));
  return true;
}

}  // namespace roverd::api
