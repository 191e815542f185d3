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
constexpr double kVagueSigma = 0.5;             // of what cannot be more: as one sigma

EnuPoint times(double s, EnuPoint p) noexcept {
  return {s * p.east_m, s * p.north_m};
}

double dot(EnuPoint a, EnuPoint b) noexcept {
  return a.east_m * b.east_m + a.north_m * b.north_m;
}

/// @param i the newest pace that is not later than `t`.
EnuPoint mps_from(const Facts& f, std::size_t i, Time t) noexcept {
  const Pace& a = f.paces[i];
  if (i == 0) return a.mps;
  const Pace& b = f.paces[i - 1];
  return a.mps + times(seconds(t - a.t) / std::max(1e-3, seconds(b.t - a.t)), b.mps - a.mps);
}

/// @param i likewise.
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

/// The way that was told without a direction, at most, m.
double vague_between(const Facts& f, Time begin, Time end) noexcept {
  const std::size_t to = f.paces.not_after(end);
  const std::size_t from = f.paces.not_after(begin);
  if (from >= f.paces.size() || to >= f.paces.size()) return 0.0;
  return f.paces[to].vague_m - f.paces[from].vague_m;
}

}  // namespace

double lag_s(EnuPoint off_m, EnuPoint faster_mps) noexcept {
  const double square = std::max(1e-6, dot(faster_mps, faster_mps));
  return std::clamp(dot(off_m, faster_mps) / square, 0.0, kLagMost_s);
}

EnuPoint without_lag(EnuPoint off_m, EnuPoint faster_mps) noexcept {
  return off_m - times(lag_s(off_m, faster_mps), faster_mps);
}

std::optional<Stretch> by_position(const Facts& f, Time begin, Time end) noexcept {
  const std::size_t to = f.spots.not_after(end);
  const std::size_t from = f.spots.not_after(begin);
  if (from >= f.spots.size()) return std::nullopt;
  const Spot& a = f.spots[from];
  const Spot& b = f.spots[to];
  if (a.run != b.run || a.t != begin || b.t != end) return std::nullopt;
  const double lately = -std::expm1(-seconds(end - begin) / std::max(1.0, b.drift_s));
  const double sigma = std::hypot(a.sigma_m, b.sigma_m, b.drift_m * std::sqrt(2.0 * lately));
  return Stretch{b.at - a.at, sigma, {}};
}

std::optional<Stretch> by_velocity(const Facts& f, Time begin, Time end) noexcept {
  if (f.paces.empty()) return std::nullopt;
  const Pace& newest = f.paces.newest();
  const auto a = sum_at(f, begin, newest.run);
  const auto b = sum_at(f, end, newest.run);
  if (!a || !b) return std::nullopt;
  const double w = seconds(end - begin);
  const double bias = (f.rtk ? kVelocityBiasRtk_mps : kVelocityBias_mps) * w;
  const EnuPoint faster =
      mps_from(f, f.paces.not_after(end), end) - mps_from(f, f.paces.not_after(begin), begin);
  const double vague_m = kVagueSigma * vague_between(f, begin, end);
  const double noise_m = newest.sigma_mps * std::sqrt(newest.every_s * w);
  return Stretch{*b - *a, std::hypot(noise_m, bias, vague_m), faster};
}

RunApart::RunApart(const Facts& facts) noexcept
    : f_(facts),
      from_(
          std::max(facts.from[index_of(Sense::Position)], facts.from[index_of(Sense::Velocity)])) {}

bool RunApart::take_next() noexcept {
  const Spot& newest = f_.spots.newest();
  if (next_ >= f_.spots.size()) return false;
  const Spot& s = f_.spots[next_];
  if (s.run != newest.run || (from_ && s.t < *from_)) return false;
  while (pace_ < f_.paces.size() && f_.paces[pace_].t > s.t) ++pace_;
  const auto sum = sum_from(f_, pace_, s.t, f_.paces.newest().run);
  if (!sum) return false;
  if (next_ == 0) first_ = s.at - *sum;  // about this one, for the figures' sake
  oldest_s_ = seconds(s.t - newest.t);
  const Apart a{oldest_s_, s.at - *sum - first_, mps_from(f_, pace_, s.t)};
  n_ += 1.0;
  t_ += a.t_s;
  tt_ += a.t_s * a.t_s;
  e_ = e_ + a.m;
  te_ = te_ + times(a.t_s, a.m);
  v_ = v_ + a.mps;
  tv_ = tv_ + times(a.t_s, a.mps);
  sigma_m_ = std::max(sigma_m_, s.sigma_m);
  all_[next_++] = a;
  return true;
}

EnuPoint RunApart::slope(EnuPoint sum, EnuPoint by_t) const noexcept {
  return times(1.0 / (tt_ - t_ * t_ / n_), by_t - times(t_ / n_, sum));
}

std::optional<Stretch> RunApart::over(double window_s) noexcept {
  ended_ = ended_ || f_.spots.empty() || f_.paces.empty();
  while (!ended_ && -oldest_s_ < window_s - 0.01) ended_ = !take_next();
  if (ended_ || n_ < kFewestSpots) return std::nullopt;
  const double w = -oldest_s_;
  const EnuPoint rise = times(w, slope(e_, te_));
  const EnuPoint faster = times(w, slope(v_, tv_));
  lag_s_ = lag_s(rise, faster);
  const Pace& pace = f_.paces.newest();
  const double noise_m = w * sigma_m_ / std::sqrt(tt_ - t_ * t_ / n_);
  const double added_m = pace.sigma_mps * std::sqrt(1.2 * pace.every_s * w);
  const double vague_m = kVagueSigma * vague_between(f_, pace.t - base::from_seconds(w), pace.t);
  const double wanders_m = std::hypot(kVelocityWanders_mps * w, vague_m);
  return Stretch{rise - times(lag_s_, faster), std::hypot(noise_m, added_m, wanders_m), faster};
}

EnuPoint RunApart::freed(const Apart& a) const noexcept {
  return a.m - times(lag_s_, a.mps);
}

/// By the squares that each takes away from those about the mean of all: a line its own part, a
/// step between k and the rest the part between their means.
bool RunApart::a_step() const noexcept {
  const EnuPoint sum = e_ - times(lag_s_, v_);
  const EnuPoint line = slope(sum, te_ - times(lag_s_, tv_));
  const double by_line = dot(line, line) * (tt_ - t_ * t_ / n_);
  double by_step = 0.0;
  EnuPoint newer;
  for (std::size_t k = 1; k < next_; ++k) {
    newer = newer + freed(all_[k - 1]);
    const auto many = static_cast<double>(k);
    const EnuPoint off = times(1.0 / many, newer) - times(1.0 / (n_ - many), sum - newer);
    by_step = std::max(by_step, dot(off, off) * many * (n_ - many) / n_);
  }
  return by_step >= by_line;
}

std::optional<Time> spot_before(const Facts& f, Time t) noexcept {
  const std::size_t i = f.spots.not_after(t);
  if (i >= f.spots.size() || seconds(t - f.spots[i].t) > 1.1) return std::nullopt;
  return f.spots[i].t;
}

}  // namespace roverd::nav
