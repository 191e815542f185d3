#include "nav/sense/health.hpp"

#include <algorithm>

namespace roverd::nav::sense {

std::string_view to_string(Eye eye) noexcept {
  switch (eye) {
    case Eye::Ok:
      return "ok";
    case Eye::Degraded:
      return "degraded";
    case Eye::Blind:
      return "blind";
  }
  return "blind";
}

void HealthWatch::took(const base::Sight& sight, const std::optional<Counts>& counts,
                       base::Time now) noexcept {
  if (last_.pieces > 0 && sight.count > count_ + 1) last_.lost += sight.count - count_ - 1;
  count_ = sight.count;
  ++last_.pieces;
  last_.window = sight.window;
  good_ = sight.good;
  placed_ = counts.has_value();
  if (!counts || !sight.good) {
    ++last_.refused;
    return;
  }
  const double all = std::max(1.0, static_cast<double>(counts->points));
  last_.unknown_part = counts->points == 0 ? 1.0 : static_cast<double>(counts->unknown) / all;
  last_.bad_part = static_cast<double>(counts->bad) / all;
  arrivals_[used_++ % kArrivals] = now;
}

Fitness HealthWatch::at(base::Time now) const {
  Fitness f = last_;
  const base::Time newest = used_ > 0 ? arrivals_[(used_ - 1) % kArrivals] : begun_;
  f.age_s = std::max(0.0, base::seconds(now - newest));
  const std::uint64_t held = std::min<std::uint64_t>(used_, kArrivals);
  if (held > 1) {
    // The last second or the last pieces, whichever is less, and up to now.
    std::uint64_t n = 0;
    base::Time oldest = newest;
    for (std::uint64_t i = 1; i < held; ++i) {
      const base::Time t = arrivals_[(used_ - 1 - i) % kArrivals];
      if (base::seconds(newest - t) > 1.0 && n >= 3) break;
      oldest = t;
      n = i;
    }
    const double span_s = base::seconds(newest - oldest);
    const double late_s = std::max(0.0, f.age_s - 1.0 / p_.rate_hz);
    if (span_s > 0.0) f.rate_hz = static_cast<double>(n) / (span_s + late_s);
  }
  const auto say = [&f](Eye eye, const char* reason) {
    if (eye <= f.eye && !f.reason.empty()) return;
    f.eye = eye;
    f.reason = reason;
  };
  f.eye = Eye::Ok;
  if (used_ > 0 && !good_) say(Eye::Blind, "it says that its data are not good");
  if (f.pieces > 0 && !placed_) say(Eye::Blind, "its last piece could not be used");
  if (f.age_s > p_.silent_s)
    say(Eye::Blind, f.pieces == 0 ? "it has told nothing yet" : "it is silent");
  if (f.window == base::Window::Blocked) say(Eye::Blind, "its window is blocked");
  if (f.unknown_part > p_.max_unknown_part) say(Eye::Blind, "too many directions tell nothing");
  if (f.bad_part > p_.max_bad_part) say(Eye::Blind, "too many of its points are no points");
  if (f.window == base::Window::Dirty) say(Eye::Degraded, "its window is dirty");
  // Half of it, or near it: of what a lidar looks at half is sky.
  if (f.unknown_part > std::max(0.5 * p_.max_unknown_part, p_.max_unknown_part - 0.25))
    say(Eye::Degraded, "many directions tell nothing");
  if (f.bad_part > 0.5 * p_.max_bad_part) say(Eye::Degraded, "many of its points are no points");
  if (used_ > 3 && f.rate_hz < p_.min_rate_part * p_.rate_hz) say(Eye::Degraded, "it is slow");
  return f;
}

}  // namespace roverd::nav::sense
