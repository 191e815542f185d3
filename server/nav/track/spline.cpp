#include "nav/track/spline.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav {
namespace {

using base::EnuPoint;

std::array<double, 4> basis(double t) noexcept {
  const double r = 1.0 - t;
  return {r * r * r / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
          (3.0 * r * r * r - 6.0 * r * r + 4.0) / 6.0, t * t * t / 6.0};
}

constexpr std::array<double, 4> kThird{-1.0, 3.0, -3.0, 1.0};

EnuPoint mixed(const EnuPoint* control, const std::array<double, 4>& by) noexcept {
  EnuPoint sum;
  for (std::size_t k = 0; k < 4; ++k) {
    sum.east_m += by[k] * control[k].east_m;
    sum.north_m += by[k] * control[k].north_m;
  }
  return sum;
}

}  // namespace

SmoothSpline::SmoothSpline(double length, double piece_m)
    : pieces_(static_cast<std::size_t>(std::max(1.0, std::ceil(length / piece_m - 1e-9)))),
      piece_(length / static_cast<double>(pieces_)),
      control_(pieces_ + 3),
      matrix_(pieces_ + 3) {}

SmoothSpline::Within SmoothSpline::within(double u) const noexcept {
  const double at = std::clamp(u / piece_, 0.0, static_cast<double>(pieces_));
  const auto i = std::min(static_cast<std::size_t>(at), pieces_ - 1);
  return {i, at - static_cast<double>(i)};
}

void SmoothSpline::fit(std::span<const SplineDatum> data, std::span<const double> stiffness) {
  std::fill(matrix_.begin(), matrix_.end(), Row{});
  std::fill(control_.begin(), control_.end(), EnuPoint{});
  const auto couple = [this](std::size_t first, const std::array<double, 4>& by, double weight) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j <= i; ++j) matrix_[first + i][i - j] += weight * by[i] * by[j];
    }
  };
  for (const SplineDatum& d : data) {
    const Within w = within(d.u);
    const auto by = basis(w.part);
    couple(w.piece, by, d.weight);
    for (std::size_t k = 0; k < 4; ++k) {
      control_[w.piece + k].east_m += d.weight * by[k] * d.at.east_m;
      control_[w.piece + k].north_m += d.weight * by[k] * d.at.north_m;
    }
  }
  for (std::size_t i = 0; i < pieces_; ++i) couple(i, kThird, stiffness[i]);
  factor();
  solve();
}

/// L·D·Lᵀ in place: the diagonal of D, and the rows of L beside it.
void SmoothSpline::factor() {
  for (std::size_t i = 0; i < matrix_.size(); ++i) {
    Row& row = matrix_[i];
    for (std::size_t back = std::min<std::size_t>(3, i); back >= 1; --back) {
      const std::size_t j = i - back;
      double sum = row[back];
      for (std::size_t k = back + 1; k <= std::min<std::size_t>(3, i); ++k) {
        sum -= row[k] * matrix_[i - k][0] * matrix_[j][k - back];
      }
      row[back] = sum / matrix_[j][0];
    }
    for (std::size_t k = 1; k <= std::min<std::size_t>(3, i); ++k) {
      row[0] -= row[k] * row[k] * matrix_[i - k][0];
    }
    row[0] = std::max(row[0], 1e-12);  // nothing holds it: it stays where its neighbours are
  }
}

void SmoothSpline::solve() noexcept {
  const auto take = [](EnuPoint& from, double by, const EnuPoint& of) {
    from.east_m -= by * of.east_m;
    from.north_m -= by * of.north_m;
  };
  const std::size_t n = control_.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 1; k <= std::min<std::size_t>(3, i); ++k) {
      take(control_[i], matrix_[i][k], control_[i - k]);
    }
  }
  for (std::size_t i = n; i-- > 0;) {
    control_[i].east_m /= matrix_[i][0];
    control_[i].north_m /= matrix_[i][0];
    for (std::size_t k = 1; k <= 3 && i + k < n; ++k) {
      take(control_[i], matrix_[i + k][k], control_[i + k]);
    }
  }
}

base::EnuPoint SmoothSpline::at(double u) const noexcept {
  const Within w = within(u);
  return mixed(&control_[w.piece], basis(w.part));
}

SplinePlace SmoothSpline::place(double u) const noexcept {
  const Within w = within(u);
  const double t = w.part;
  const double r = 1.0 - t;
  const EnuPoint* c = &control_[w.piece];
  const double by = 1.0 / piece_;
  const std::array<double, 4> first{-0.5 * r * r * by, (1.5 * t * t - 2.0 * t) * by,
                                    (-1.5 * r * r + 2.0 * r) * by, 0.5 * t * t * by};
  const std::array<double, 4> second{r * by * by, (3.0 * t - 2.0) * by * by,
                                     (3.0 * r - 2.0) * by * by, t * by * by};
  return {mixed(c, basis(t)), mixed(c, first), mixed(c, second)};
}

}  // namespace roverd::nav
