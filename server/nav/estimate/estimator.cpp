// What it begins with, what it learned, and time.

#include "nav/estimate/estimator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

using base::rad_from_deg;
using base::Refusal;
using base::seconds;

// Without odometry: how wrong the receiver's velocity is, how fast it grows old, and how fast a
// robot may be of which nothing is known (1 sigma).
constexpr double kCoastSpeed_mps = 0.15;
constexpr double kCoastAccel_mps2 = 0.5;
constexpr double kBlindSpeed_mps = 1.0;
// So much of what seems to be a slide, and a centre of turns so far off, is taken for the ground's.
constexpr double kSlideBelieved = 0.12;
constexpr double kPivotBelieved_m = 0.15;
// A fixed solution errs slowly too, by reflections: what does not average out.
constexpr double kFixedWanders_m = 0.006;

}  // namespace

Estimator::Estimator(base::Setting<EstimateParams> setting) : params_(std::move(setting)) {
  const EstimateParams& params = *params_;
  reset_state(belief_, kYaw, 0.0, base::kPi);
  reset_state(belief_, kGyroBias, 0.0, rad_from_deg(params.gyro_bias_sigma_dps));
  reset_state(belief_, kBias, 0.0, rad_from_deg(params.compass_bias_sigma_deg));
  const double per_a = rad_from_deg(params.compass_current_sigma_deg_per_a);
  // Clockwise on a compass is a smaller yaw.
  reset_state(belief_, kCompassLeft, -rad_from_deg(params.compass_left_deg_per_a), per_a);
  reset_state(belief_, kCompassRight, -rad_from_deg(params.compass_right_deg_per_a), per_a);
  reset_state(belief_, kScale, 1.0, params.odometry_scale_sigma);
  reset_state(belief_, kCrab, 0.0, kCrabUnseen);
  for (const StateIndex i : {kSlideE, kSlideN}) reset_state(belief_, i, 0.0, kSlideAtFirst);
  reset_state(belief_, kYawScale, params.yaw_scale, params.yaw_scale_sigma);
  reset_state(belief_, kPull, 0.0, params.pull_sigma_1pm);
  reset_state(belief_, kPivot, 0.0, params.pivot_sigma_m);
  if (params.has_map()) {
    frame_.emplace(1, base::LatLon{params.map_lat, params.map_lon});
    next_frame_id_ = 2'000'000'000;  // of a first fix that lies elsewhere
  }
}

void Estimator::recall(const Learned& learned) noexcept {
  const auto take = [this](const std::optional<LearnedValue>& known, StateIndex i, double least,
                           double from, double to) {
    if (!known || !(known->value >= from && known->value <= to)) return;
    const double sigma = std::max(least, known->sigma);
    if (sigma * sigma < belief_.P(i, i)) reset_state(belief_, i, known->value, sigma);
  };
  take(learned.odometry_scale, kScale, kScaleRecalled, 0.5, 1.2);
  take(learned.gyro_bias_radps, kGyroBias, kGyroBiasRecalled_radps, -0.2, 0.2);
  take(learned.yaw_scale, kYawScale, kYawScaleRecalled, 0.3, 1.5);
  take(learned.pull_1pm, kPull, kPullRecalled_1pm, -0.3, 0.3);
  take(learned.pivot_m, kPivot, kPivotRecalled_m, -1.0, 1.0);
}

void Estimator::adopt(const Learned& learned) noexcept {
  const auto take = [this](const std::optional<LearnedValue>& known, StateIndex i, double least) {
    if (known) reset_state(belief_, i, known->value, std::max(least, known->sigma));
  };
  take(learned.odometry_scale, kScale, 0.5 * kScaleLearned);
  take(learned.yaw_scale, kYawScale, 0.5 * kYawScaleRecalled);
  take(learned.pull_1pm, kPull, 0.5 * kPullRecalled_1pm);
}

void Estimator::forget_vehicle() noexcept {
  const EstimateParams& params = *params_;
  reset_state(belief_, kScale, 1.0, params.odometry_scale_sigma);
  reset_state(belief_, kYawScale, params.yaw_scale, params.yaw_scale_sigma);
  reset_state(belief_, kPull, 0.0, params.pull_sigma_1pm);
  reset_state(belief_, kPivot, 0.0, params.pivot_sigma_m);
}

Learned Estimator::learned() const noexcept {
  Learned out;
  const auto tell = [this](StateIndex i, double enough) -> std::optional<LearnedValue> {
    const double sigma = std::sqrt(std::max(0.0, belief_.P(i, i)));
    if (sigma > enough) return std::nullopt;
    return LearnedValue{belief_.x(i), sigma};
  };
  if (has_moved_ && params_->odometry_scale_sigma > kScaleLearned) {
    out.odometry_scale = tell(kScale, kScaleLearned);
  }
  if (has_moved_ && params_->pivot_sigma_m > kPivotLearned_m) {
    out.pivot_m = tell(kPivot, kPivotLearned_m);
  }
  if (last_inertial_) out.gyro_bias_radps = tell(kGyroBias, kGyroBiasLearned_radps);
  return out;
}

void Estimator::use_frame(const base::LocalFrame& frame) noexcept {
  if (!located_) frame_ = frame;
}

void Estimator::take(const base::Measurement& m, Time now) noexcept {
  now_ = now;
  std::visit(
      [this](const auto& value) {
        if constexpr (requires { this->take(value); }) this->take(value);
      },
      m);
}

bool Estimator::in_order(Input& input, std::optional<Time>& last, Time stamp) noexcept {
  if (stamp > now_ + kFuture || (last && stamp <= *last)) {
    refuse(input, Refusal::Stamp);
    return false;
  }
  last = stamp;
  return true;
}

void Estimator::refuse(Input& input, Refusal why) noexcept {
  ++input.rejected;
  ++health_.rejected;
  ++health_.refusals[static_cast<std::size_t>(why)];
  input.why = why;
  if (!input.refused_since) input.refused_since = now_;
}

bool Estimator::has_odometry(Time at) const noexcept {
  return tracks_at_ && at - *tracks_at_ < kOdometryGone;
}

/// Long enough that what may still be learned at rest was learned.
bool Estimator::settled_in(std::optional<Time> since) const noexcept {
  return has_moved_ || (since && now_ - *since > std::chrono::seconds(10));
}

// ---- time --------------------------------------------------------------------------------------

void Estimator::advance(Time now) noexcept {
  now_ = now;
  vote(now);
  watch_alignment();
  if (!filter_at_) filter_at_ = now;
  if (has_odometry(now)) return;
  standing_ = false;
  const double dt_s = seconds(now - *filter_at_);
  if (dt_s <= 0.0) return;
  Coast c = coast(now);
  if (!votes_.out(base::Sense::Gyro)) c.gyro_rad = gyro_.turned_rad(*filter_at_, now);
  gyro_used_ = c.gyro_rad.has_value();
  const double yaw_before = belief_.x(kYaw);
  if (located_ || heading_known_) predict_coasting(belief_, c, dt_s, drift_);
  sums_.turned_rad += base::angle_diff_rad(yaw_before, belief_.x(kYaw));
  tracks_ = {};
  remember(now);
}

/// The last velocity over ground, which is worth less every moment; without any it may stand or
/// drive, nobody knows.
Coast Estimator::coast(Time now) const noexcept {
  Coast c;
  c.sigma_mps = kBlindSpeed_mps;
  const double age_s = velocity_ ? seconds(now - velocity_->stamp) : 1e9;
  if (age_s < seconds(kGnssGone)) {
    c.velocity_mps = {velocity_->east_mps, velocity_->north_mps};
    c.sigma_mps = std::min(kCoastSpeed_mps + kCoastAccel_mps2 * age_s, kBlindSpeed_mps);
  }
  const auto known = std::max(tracks_at_, last_fused_);
  c.blind_s = known ? std::max(0.0, seconds(now - *known)) : 0.0;
  return c;
}

/// A receiver that runs away is answered by a slide, too: what it makes of one is bounded, and
/// where another sense speaks against it, nothing is made of it.
base::OverGround Estimator::over_ground(double speed_mps, double yaw_rate_radps) const noexcept {
  const double c = std::cos(belief_.x(kYaw));
  const double s = std::sin(belief_.x(kYaw));
  const double e = belief_.x(kSlideE);
  const double n = belief_.x(kSlideN);
  const bool out = votes_.out(base::Sense::Position) || votes_.out(base::Sense::Velocity);
  const double trust = heading_known_ && !out ? 1.0 - suspected_course() : 0.0;
  const double most = kSlideBelieved * trust;
  const double way_mps = std::abs(tracks_.linear_mps);
  const double pivot_m = std::clamp(belief_.x(kPivot), -kPivotBelieved_m, kPivotBelieved_m);
  return {speed_mps + way_mps * std::clamp(c * e + s * n, -most, most),
          way_mps * std::clamp(c * n - s * e, -most, most) - pivot_m * yaw_rate_radps};
}

std::optional<base::Pose> Estimator::pose(Time now) const {
  if (!located_ || !frame_ || !filter_at_) return std::nullopt;
  base::Pose p;
  const bool odometry = has_odometry(now);
  const bool gnss = last_fused_ && !placed_ && now - *last_fused_ < kGnssGone;
  const bool map = gnss && health_.by_map;
  const bool landmark = gnss && !map && last_by_landmark_ && now - *last_by_landmark_ < kGnssGone;
  const bool velocity = velocity_ && now - velocity_->stamp < kGnssGone;
  // Carried on from something fresh it is of now; from nothing it grows old.
  const auto velocity_at = velocity_ ? std::optional(velocity_->stamp) : std::nullopt;
  const auto last_word = std::max({tracks_at_, last_fused_, velocity_at});
  p.stamp = odometry || gnss || velocity ? now : last_word.value_or(now);
  p.yaw_rad = belief_.x(kYaw);
  p.heading_known = heading_known_;
  p.at = {belief_.x(kEast), belief_.x(kNorth)};
  const double dt_s = std::clamp(seconds(now - *filter_at_), 0.0, 0.2);
  if (gyro_used_) p.yaw_rate_radps = standing_ ? 0.0 : gyro_.rate_radps() - belief_.x(kGyroBias);
  if (odometry) {
    const double speed_mps = belief_.x(kScale) * tracks_.linear_mps;
    const double yaw_rate_radps = p.yaw_rate_radps.value_or(
        belief_.x(kYawScale) * tracks_.angular_radps + belief_.x(kPull) * tracks_.linear_mps);
    const double middle_rad = p.yaw_rad + 0.5 * yaw_rate_radps * dt_s;
    const double back = tracks_.linear_mps < 0.0 ? -1.0 : 1.0;
    const Eigen::Vector2d way =
        std::abs(tracks_.linear_mps) * dt_s * way_per_m(belief_.x, middle_rad, back) +
        yaw_rate_radps * dt_s * way_per_rad(belief_.x, middle_rad);
    p.at = p.at + base::EnuPoint{way.x(), way.y()};
    p.yaw_rad = base::wrap_rad(p.yaw_rad + yaw_rate_radps * dt_s);
    p.speed_mps = speed_mps;
    p.yaw_rate_radps = yaw_rate_radps;
    p.over_ground = over_ground(speed_mps, yaw_rate_radps);
  } else if (velocity) {
    p.speed_mps = std::hypot(velocity_->east_mps, velocity_->north_mps);
  }
  p.global = frame_->to_global(p.at);
  // Axes of the covariance: mean of the variances ± half their spread.
  const double wanders_m = drift_.sigma_m > 0.0 ? 0.0 : kFixedWanders_m;
  const double doubt_m2 = unknown_m() * unknown_m() + wanders_m * wanders_m;
  const double least_m2 = coarse_walk_.least_m2();
  const double a = std::max(least_m2, belief_.P(kEast, kEast)) + doubt_m2;
  const double b = std::max(least_m2, belief_.P(kNorth, kNorth)) + doubt_m2;
  const double c = belief_.P(kEast, kNorth);
  const double half = std::hypot(0.5 * (a - b), c);
  p.ellipse.major_m = std::sqrt(std::max(0.0, 0.5 * (a + b) + half));
  p.ellipse.minor_m = std::sqrt(std::max(0.0, 0.5 * (a + b) - half));
  p.ellipse.major_yaw_rad = 0.5 * std::atan2(2.0 * c, a - b);
  p.horizontal_sigma_m = p.ellipse.major_m;
  p.yaw_sigma_rad = base::kPi;
  p.heading_sigma_rad = base::kPi;
  if (heading_known_) {
    const double sigma_rad = std::sqrt(std::max(0.0, belief_.P(kYaw, kYaw)));
    p.yaw_sigma_rad = std::min(base::kPi, std::hypot(sigma_rad, unknown_rad()));
    p.heading_sigma_rad = std::min(base::kPi, std::hypot(p.yaw_sigma_rad, aside_rad()));
  }
  p.alt_msl_m = alt_msl_m_;
  if (odometry) {
    p.source = map        ? "map+odometry"
               : landmark ? "landmark+odometry"
               : gnss     ? "gnss+odometry"
                          : "odometry";
  } else {
    p.source = map ? "map" : "gnss";
  }
  return p;
}

}  // namespace roverd::nav
