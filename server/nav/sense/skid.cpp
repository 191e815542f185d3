#include "nav/sense/skid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "nav/sense/protect_parts.hpp"

namespace roverd::nav::sense {

namespace {

constexpr double kSkidsSlow_mps = 0.2;  // no slower for this
constexpr double kTellsWay_mps = 0.1;   // slower, it tells nothing of how it moves
constexpr double kLately_s = 0.15;
constexpr double kMostAside_rad = 0.35;
constexpr double kAsTold_m = 0.02;  // aside of the commanded curve, when it stands
constexpr double kAnyCreep = 1e3;

struct Way {
  double curve_pm = 0.0;
  double aside_rad = 0.0;
};

/// The body goes along a line that is turned: seen along that line, the body is turned back.
Verdict along_way(const Patch& patch, const Pose2& pose, const Footprint& body, double v_mps,
                  const Way& way, const ProtectParams& params, const Marks* marks) noexcept {
  const base::BodyTwist twist{v_mps, way.curve_pm * v_mps};
  if (way.aside_rad == 0.0) return protect(patch, pose, body, twist, params, nullptr, marks);
  Verdict there = protect(patch, pose * Pose2{0.0, 0.0, way.aside_rad}, body.turned(-way.aside_rad),
                          twist, params, nullptr, marks);
  const Pose2 at = Pose2{0.0, 0.0, way.aside_rad} * Pose2{there.at.x, there.at.y, 0.0};
  there.at = {at.x_m, at.y_m};
  there.bearing_rad = std::atan2(there.at.y, there.at.x);
  return there;
}

}  // namespace

void Lately::move(const Odometry& now, double dt_s) noexcept {
  const double part = std::clamp(dt_s / kLately_s, 0.0, 1.0);
  v_mps_ += part * (now.v_mps - v_mps_);
  left_mps_ += part * (now.left_mps - left_mps_);
  yaw_rate_radps_ += part * (now.yaw_rate_radps - yaw_rate_radps_);
}

double Lately::aside_rad() const noexcept {
  return std::clamp(std::atan(left_mps_ / v_mps_), -kMostAside_rad, kMostAside_rad);
}

Verdict protect_skidding(const Patch& patch, const Pose2& pose, const Footprint& body,
                         const base::BodyTwist& twist, const Lately& lately, bool steered,
                         const ProtectParams& params, const Marks* marks) noexcept {
  Verdict least;
  const double v = twist.linear_mps;
  const double fast = std::abs(v);
  if (fast < kSkidsSlow_mps || turns_on_the_spot(twist, body)) return least;
  ProtectParams p = params;
  p.creep_mps = p.creep_back_mps = p.creep_turn_radps = kAnyCreep;
  p.gap_m = p.side_m;
  const double told_pm = twist.angular_radps / v;
  const double stops_m = fast * (p.delay_s + 0.5 * fast / p.decel_mps2);
  const bool tells = v * lately.v_mps() > kTellsWay_mps * fast;
  Way moves{tells ? lately.curve_pm() : told_pm, tells ? lately.aside_rad() : 0.0};
  if (std::abs(moves.aside_rad) * stops_m < kAsTold_m) moves.aside_rad = 0.0;
  const std::array ways{moves, Way{0.0, moves.aside_rad}};
  for (std::size_t i = 0; i < (steered ? 1U : 2U); ++i) {
    const double off_m = 0.5 * std::abs(ways[i].curve_pm - told_pm) * stops_m * stops_m;
    if (off_m < kAsTold_m && ways[i].aside_rad == 0.0) continue;
    const Verdict there = along_way(patch, pose, body, v, ways[i], p, marks);
    if (there.limit != Limit::None && there.part < least.part) least = there;
  }
  if (least.limit != Limit::None)
    least.part = std::min(1.0, std::max(least.part, kSkidsSlow_mps / fast));
  return least;
}

}  // namespace roverd::nav::sense
