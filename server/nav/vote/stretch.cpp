#include "nav/vote/stretch.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav {
namespace {

using base::EnuPoint;
using base::seconds;

constexpr double kVelocityBiasRtk_mps = 0.01;
constexpr double kVelocityBias_mps = 0.03;

EnuPoint times(double s, EnuPoint p) noexcept {
  return {s * p.east_m, s * p.north_m};
}

std::optional<EnuPoint> sum_at(const Facts& f, Time t, int run) noexcept {
  const std::size_t i = f.paces.not_after(t);
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

std::optional<Time> spot_before(const Facts& f, Time t) noexcept {
  const std::size_t i = f.spots.not_after(t);
  if (i >= f.spots.size() || seconds(t - f.spots[i].t) > 1.1) return std::nullopt;
  return f.spots[i].t;
}

}  // namespace roverd::nav
