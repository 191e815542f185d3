#pragma once
// Where the body was: the last seconds of the odometry, to bring what was measured at different
// moments to one. Frame O of the odometry: it drifts and never jumps; x, y in metres, yaw left
// positive. Where something tells how the body leans, its lie is kept as well: heights over O's
// plane are comparable from one scan to the next however the ground tips the body. Where nothing
// does, the body is level.

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "base/angle.hpp"
#include "base/time.hpp"

namespace roverd::nav::sense {

/// A pose in the plane: of B in O, or of B at one time in B at another.
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
};

/// X_AC = X_AB X_BC.
inline Pose2 operator*(const Pose2& ab, const Pose2& bc) noexcept {
  const double c = std::cos(ab.yaw_rad);
  const double s = std::sin(ab.yaw_rad);
  return {ab.x_m + c * bc.x_m - s * bc.y_m, ab.y_m + s * bc.x_m + c * bc.y_m,
          base::wrap_rad(ab.yaw_rad + bc.yaw_rad)};
}

/// X_BA of X_AB.
inline Pose2 inverse(const Pose2& ab) noexcept {
  const double c = std::cos(ab.yaw_rad);
  const double s = std::sin(ab.yaw_rad);
  return {-c * ab.x_m - s * ab.y_m, s * ab.x_m - c * ab.y_m, base::wrap_rad(-ab.yaw_rad)};
}

/// How the body lies in O. Angles as base::Attitude tells them.
struct Lie3 {
  double z_m = 0.0;        ///< of the body's origin
  double roll_rad = 0.0;   ///< right side down positive
  double pitch_rad = 0.0;  ///< nose up positive
  bool told = false;       ///< something tells so now; else as it did last, or level
};

/// What to multiply a place in B with for its height in O, less z_m: the vertical, seen from B.
inline std::array<double, 3> up_in_body(const Lie3& lie) noexcept {
  const double level = std::cos(lie.pitch_rad);
  return {std::sin(lie.pitch_rad), std::sin(lie.roll_rad) * level, std::cos(lie.roll_rad) * level};
}

struct Odometry {
  base::Time stamp;
  Pose2 pose;  ///< X_OB
  double v_mps = 0.0;
  double yaw_rate_radps = 0.0;
  Lie3 lie{};
  double left_mps = 0.0;  ///< aside, to its left
};

/// Along the arc of a twist. Source: the unicycle's exact integral.
inline Pose2 along(double v_mps, double yaw_rate_radps, double dt_s) noexcept {
  const double turn = yaw_rate_radps * dt_s;
  const double d = v_mps * dt_s;
  if (std::abs(turn) < 1e-6) return {d, 0.5 * d * turn, turn};
  return {d * std::sin(turn) / turn, d * (1.0 - std::cos(turn)) / turn, turn};
}

/// The same of a body that goes aside as well: by the middle of the turn.
inline Pose2 along(double v_mps, double left_mps, double yaw_rate_radps, double dt_s) noexcept {
  const Pose2 arc = along(v_mps, yaw_rate_radps, dt_s);
  const double left_m = left_mps * dt_s;
  const double middle_rad = 0.5 * yaw_rate_radps * dt_s;
  return {arc.x_m - left_m * std::sin(middle_rad), arc.y_m + left_m * std::cos(middle_rad),
          arc.yaw_rad};
}

/// A ring of 256 states, 5.1 s at 50 Hz; the oldest goes first. No allocation. A state that is not
/// newer than the newest, or not finite, is refused.
class PoseHistory {
 public:
  /// How far beyond the newest state its twist is trusted.
  static constexpr double kAhead_s = 0.2;

  bool push(const Odometry& o) noexcept {
    if (size_ > 0 && o.stamp <= back(0).stamp) return false;
    if (!std::isfinite(o.pose.x_m + o.pose.y_m + o.pose.yaw_rad + o.v_mps + o.left_mps +
                       o.yaw_rate_radps) ||
        !std::isfinite(o.lie.z_m + o.lie.roll_rad + o.lie.pitch_rad)) {
      return false;
    }
    head_ = (head_ + 1) % ring_.size();
    ring_[head_] = o;
    if (size_ < ring_.size()) ++size_;
    return true;
  }
  void clear() noexcept { size_ = 0; }
  bool empty() const noexcept { return size_ == 0; }
  const Odometry& newest() const noexcept { return back(0); }

  /// X_OB at a time. Between states in proportion to the time; after the newest along its
  /// twist, kAhead_s at most. Empty: earlier than what is kept, or later than that.
  std::optional<Pose2> at(base::Time t) const noexcept {
    if (size_ == 0) return std::nullopt;
    if (t >= back(0).stamp) {
      const double ahead_s = base::seconds(t - back(0).stamp);
      if (ahead_s > kAhead_s) return std::nullopt;
      const Odometry& last = back(0);
      return last.pose * along(last.v_mps, last.left_mps, last.yaw_rate_radps, ahead_s);
    }
    if (t < back(size_ - 1).stamp) return std::nullopt;
    const std::size_t newer = next_after(t);
    return between(back(newer + 1), back(newer), t);
  }

  /// How it lay then; of a time that is not kept: as it did at the nearest that is.
  Lie3 lie_at(base::Time t) const noexcept {
    if (size_ == 0) return {};
    if (t >= back(0).stamp) return back(0).lie;
    if (t <= back(size_ - 1).stamp) return back(size_ - 1).lie;
    const std::size_t newer = next_after(t);
    const Odometry& a = back(newer + 1);
    const Odometry& b = back(newer);
    const double part = base::seconds(t - a.stamp) / base::seconds(b.stamp - a.stamp);
    return {std::lerp(a.lie.z_m, b.lie.z_m, part), std::lerp(a.lie.roll_rad, b.lie.roll_rad, part),
            std::lerp(a.lie.pitch_rad, b.lie.pitch_rad, part), a.lie.told && b.lie.told};
  }

 private:
  /// The first that is later than t, by halves. @param t from the oldest to before the newest
  std::size_t next_after(base::Time t) const noexcept {
    std::size_t newer = 0;
    std::size_t older = size_ - 1;
    while (older - newer > 1) {
      const std::size_t middle = (newer + older) / 2;
      (back(middle).stamp > t ? newer : older) = middle;
    }
    return newer;
  }
  const Odometry& back(std::size_t n) const noexcept {
    return ring_[(head_ + ring_.size() - n) % ring_.size()];
  }
  static Pose2 between(const Odometry& a, const Odometry& b, base::Time t) noexcept {
    const double part = base::seconds(t - a.stamp) / base::seconds(b.stamp - a.stamp);
    return {a.pose.x_m + part * (b.pose.x_m - a.pose.x_m),
            a.pose.y_m + part * (b.pose.y_m - a.pose.y_m),
            base::wrap_rad(a.pose.yaw_rad +
                           part * base::angle_diff_rad(a.pose.yaw_rad, b.pose.yaw_rad))};
  }

  std::array<Odometry, 256> ring_{};
  std::size_t head_ = 0;
  std::size_t size_ = 0;
};

}  // namespace roverd::nav::sense
