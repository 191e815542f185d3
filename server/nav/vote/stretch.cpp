#include "nav/vote/stretch.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav {
namespace {

using base::EnuPoint;
using base::seconds;

constexpr double kVelocityBiasRtk_mps = 0.01;
constexpr double kVelocityBias_mps = 0.03;
constexpr double kVelocityWanders_mps = 0.003;  // of RTK's, beside its noise, for many seconds
constexpr double kFewestSpots = 5.0;            // positions, that make a line

EnuPoint times(double s, EnuPoint p) noexcept {
  return {s * p.east_m, s * p.north_m};
}

/// @param i the newest pace that is not later than `t`.
std::optional<EnuPoint> sum_from(const Facts& f, std::size_t i, Time t, int run) noexcept {
  if (i >= f.paces.size() || f.paces[i].run != run) return std::nullopt;
  const Pace& a = f.paces[i];
  const double after_s = seconds(t - a.t);
  if (i == 0) {
    if (after_s > 0.3) return std::nullopt;
    return a.sum_m + times(after_s, a.mps);
  }
  const Pace& b = f.paces[i - 1];
  const double part = after_s / std::max(1e-3, seconds(b.t - a.t));
  return a.sum_m + times(after_s, a.mps + times(0.5 * part, b.mps - a.mps));
}

std::optional<EnuPoint> sum_at(const Facts& f, Time t, int run) noexcept {
  return sum_from(f, f.paces.not_after(t), t, run);
}

}  // namespace

std::optional<Stretch> by_position(const Facts& f, Time begin, Time end) noexcept {
  const std::size_t to = f.spots.not_after(end);
  const std::size_t from = f.spots.not_after(begin);
  if (from >= f.spots.size()) return std::nullopt;
  const Spot& a = f.spots[from];
  const Spot& b = f.spots[to];
  if (a.run != b.run || a.t != begin || b.t != end) return std::nullopt;
  const double lately = -std::expm1(-seconds(end - begin) / std::max(1.0, b.drift_s));
  const double sigma = std::hypot(a.sigma_m, b.sigma_m, b.drift_m * std::sqrt(2.0 * lately));
  return Stretch{b.at - a.at, sigma};
}

std::optional<Stretch> by_velocity(const Facts& f, Time begin, Time end) noexcept {
  if (f.paces.empty()) return std::nullopt;
  const Pace& newest = f.paces.newest();
  const auto a = sum_at(f, begin, newest.run);
  const auto b = sum_at(f, end, newest.run);
  if (!a || !b) return std::nullopt;
  const double w = seconds(end - begin);
  const double bias = (f.rtk ? kVelocityBiasRtk_mps : kVelocityBias_mps) * w;
  return Stretch{*b - *a, std::hypot(newest.sigma_mps * std::sqrt(newest.every_s * w), bias)};
}

RunApart::RunApart(const Facts& facts, std::optional<Time> from) noexcept
    : f_(facts), from_(from) {}

std::optional<Stretch> RunApart::over(double window_s) noexcept {
  if (f_.spots.empty() || f_.paces.empty()) return std::nullopt;
  const Spot& newest = f_.spots.newest();
  const Pace& pace = f_.paces.newest();
  while (-oldest_s_ < window_s - 0.01) {
    if (next_ >= f_.spots.size()) return std::nullopt;
    const Spot& s = f_.spots[next_];
    if (s.run != newest.run || (from_ && s.t < *from_)) return std::nullopt;
    while (pace_ < f_.paces.size() && f_.paces[pace_].t > s.t) ++pace_;
    const auto sum = sum_from(f_, pace_, s.t, pace.run);
    if (!sum) return std::nullopt;
    if (next_ == 0) first_ = s.at - *sum;  // about this one, for the figures' sake
    const EnuPoint e = s.at - *sum - first_;
    oldest_s_ = seconds(s.t - newest.t);
    n_ += 1.0;
    t_ += oldest_s_;
    tt_ += oldest_s_ * oldest_s_;
    e_ = e_ + e;
    te_ = te_ + times(oldest_s_, e);
    sigma_m_ = std::max(sigma_m_, s.sigma_m);
    ++next_;
  }
  if (n_ < kFewestSpots) return std::nullopt;
  const double w = -oldest_s_;
  const double sxx = tt_ - t_ * t_ / n_;
  const EnuPoint rise = times(w / sxx, te_ - times(t_ / n_, e_));
  const double noise_m = w * sigma_m_ / std::sqrt(sxx);
  const double added_m = pace.sigma_mps * std::sqrt(1.2 * pace.every_s * w);
  return Stretch{rise, std::hypot(noise_m, added_m, kVelocityWanders_mps * w)};
}

std::optional<Time> spot_before(const Facts& f, Time t) noexcept {
  const std::size_t i = f.spots.not_after(t);
  if (i >= f.spots.size() || seconds(t - f.spots[i].t) > 1.1) return std::nullopt;
  return f.spots[i].t;
}

}  // namespace roverd::nav
