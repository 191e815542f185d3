#pragma once
// What the ground makes of a turn: turned = scale · told + bias · way, by least squares over whole
// stretches from standing to standing, so that no delay counts. Turns to both sides and straight
// ways part the two. Pure but for its memory; no allocation.

#include <algorithm>
#include <cmath>
#include <optional>

namespace roverd::nav {

class TurnFit {
 public:
  struct Found {
    double scale = 1.0;
    double scale_sigma = 0.0;
    double bias_1pm = 0.0;
    double bias_sigma_1pm = 0.0;
  };

  /// @param turned_rad over ground, @param told_rad and @param way_m of tracks or wheels, signed
  /// @param sigma_rad of turned_rad
  void take(double turned_rad, double told_rad, double way_m, double sigma_rad) noexcept {
    const double w = 1.0 / (sigma_rad * sigma_rad);
    tt_ += w * told_rad * told_rad;
    tw_ += w * told_rad * way_m;
    ww_ += w * way_m * way_m;
    ty_ += w * told_rad * turned_rad;
    wy_ += w * way_m * turned_rad;
    yy_ += w * turned_rad * turned_rad;
    ++n_;
  }
  /// Empty: the stretches do not part the two.
  std::optional<Found> found() const noexcept {
    const double det = tt_ * ww_ - tw_ * tw_;
    if (n_ < 3 || det <= 1e-3 * tt_ * ww_) return std::nullopt;
    Found out;
    out.scale = (ty_ * ww_ - wy_ * tw_) / det;
    out.bias_1pm = (wy_ * tt_ - ty_ * tw_) / det;
    const double left = yy_ - out.scale * ty_ - out.bias_1pm * wy_;
    const double unit = std::max(1.0, left / std::max(1, n_ - 2));
    out.scale_sigma = std::sqrt(unit * ww_ / det);
    out.bias_sigma_1pm = std::sqrt(unit * tt_ / det);
    return out;
  }

 private:
  double tt_ = 0.0, tw_ = 0.0, ww_ = 0.0, ty_ = 0.0, wy_ = 0.0, yy_ = 0.0;
  int n_ = 0;
};

}  // namespace roverd::nav
