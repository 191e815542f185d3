// Sensors that contradict each other: who is left out, and what no claim survives.

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/estimate/estimator.hpp"

namespace roverd::nav {
namespace {

using base::Difference;
using base::Sense;

constexpr double kLeastSpeed_mps = 0.3;  // slower, a velocity's error says nothing of a direction
constexpr double kMostDoubt_rad = 1.0;
const double kUnproved_rad = base::rad_from_deg(3.0);  // of antennas whose mounting nobody saw
constexpr double kScaleDoubt = 0.05;
/// That sensors agree again says little of what they differed by a moment ago: one that comes with
/// another fix class is not compared with what it said before.
constexpr double kFades_s = 10.0;
constexpr double kAnyGrade = 0.2;  // tangent, where nothing tells how the ground leans
constexpr double kProved_s = 10.0;
constexpr base::Duration kRefusedLasts = std::chrono::milliseconds(350);  // more than one outlier
constexpr base::Duration kRefusedCounts = std::chrono::seconds(1);

}  // namespace

void Estimator::vote(Time now) noexcept {
  Belonging b;
  b.yaw_rad = belief_.x(kYaw);
  b.yaw_sigma_rad = heading_known_ ? std::sqrt(std::max(0.0, belief_.P(kYaw, kYaw))) : base::kPi;
  b.scale = belief_.x(kScale);
  b.scale_sigma = std::sqrt(std::max(0.0, belief_.P(kScale, kScale)));
  b.pull_1pm = belief_.x(kPull);
  b.pull_sigma_1pm = std::sqrt(std::max(0.0, belief_.P(kPull, kPull)));
  b.gyro_bias_sigma_radps = std::sqrt(std::max(0.0, belief_.P(kGyroBias, kGyroBias)));
  b.arm_m = std::hypot(params_->antenna_forward_m, params_->antenna_left_m);
  const Arm leaning = arm(0.0);
  b.arm = {leaning.east_m, leaning.north_m};
  const auto lean = tilt_.at(now);
  if (lean) b.downhill = {-std::tan(lean->pitch_rad), -std::tan(lean->roll_rad)};
  b.downhill_sigma = lean ? 0.0 : kAnyGrade;
  b.yaw_scale = belief_.x(kYawScale);
  b.positions_proved = proved();
  const auto liar =
      votes_.step(b, params_->contradiction_sigma, params_->contradiction_return_s, now);
  const double since_s = voted_ ? base::seconds(now - *voted_) : 0.0;
  voted_ = now;
  // What nothing has proved yet errs as it erred: quiet alone makes no lie a truth.
  const double stays =
      proved() || fused_type_ != base::FixType::RtkFixed ? std::exp(-since_s / kFades_s) : 1.0;
  differed_m_ = std::max(votes_.told().doubt_m, differed_m_ * stays);
  if (votes_.told().unproved_differed == now) proving_s_ = 0.0;  // it was no proof
  if (liar) spoil(*liar);
}

/// @return true: it is left out, and counted as refused.
bool Estimator::outvoted(Sense s, Input& input) noexcept {
  if (!votes_.out(s)) return false;
  refuse(input, base::Refusal::Outvoted);
  return true;
}

/// Had positions come for so long while it drove that a wrong one would have contradicted itself?
bool Estimator::proved() const noexcept {
  return proving_s_ >= kProved_s;
}

/// A fix was believed. Standing, a wrong one contradicts nobody; and after a gap it may be as wrong
/// as the first one ever.
void Estimator::count_as_proof(Time stamp) noexcept {
  if (!proving_at_ || stamp - *proving_at_ > kGnssGone) {
    proving_s_ = 0.0;
  } else if (!standing_) {
    proving_s_ += base::seconds(stamp - *proving_at_);
  }
  proving_at_ = stamp;
}

/// The way that a difference may have led astray.
double Estimator::spoiled_way_m(const Difference& off) const noexcept {
  if (off.of == Difference::Of::Way) return std::abs(off.size);
  const double speed = std::abs(belief_.x(kScale) * tracks_.linear_mps);
  return 0.5 * std::min(std::abs(off.size), kMostDoubt_rad) * speed * off.window_s;
}

double Estimator::claimed_m(const Belief& b) const noexcept {
  const double variance = std::max(b.P(kEast, kEast), b.P(kNorth, kNorth));
  return std::sqrt(std::max(0.0, variance - doubted_m_ * doubted_m_));
}

/// What no claim of the position may be better than, beside what the belief itself says.
double Estimator::unknown_m() const noexcept {
  const bool refused = !votes_.out(Sense::Position) && position_off_since_ && last_fix_ &&
                       now_ - *last_fix_ < kRefusedCounts &&
                       *last_fix_ - *position_off_since_ >= kRefusedLasts;
  const bool unsettled = refused || health_.base_shift;
  const double off_m = unsettled ? refused_m_ : 0.0;
  return std::hypot(std::hypot(differed_m_, distrust_m_), off_m, map_floor_m());
}

double Estimator::unknown_rad() const noexcept {
  const bool antennas = last_antennas_ && now_ - *last_antennas_ < kGnssGone;
  const bool unproved = antennas && !health_.antennas_askew && !askew_watch_.proved();
  return std::hypot(std::hypot(votes_.told().doubt_rad, distrust_rad_),
                    unproved ? kUnproved_rad : 0.0, map_floor_rad());
}

/// How far it may point beside where it drives without anybody seeing it. A crab that stays is no
/// error of the way, so that the belief holds it for a heading; who asks where it points is told.
double Estimator::aside_rad() const noexcept {
  const bool antennas = last_antennas_ && now_ - *last_antennas_ < kGnssGone;
  if (antennas && !health_.antennas_askew && askew_watch_.proved()) return 0.0;
  if (health_.by_map && map_is_fresh()) return 0.0;  // a scanner sees where it points
  const auto lean = tilt_.at(now_);
  const double grade = lean ? std::hypot(std::tan(lean->roll_rad), std::tan(lean->pitch_rad)) : 0.0;
  return kAside_rad + kAsidePerGrade_rad * grade;
}

/// What was believed of the one that is left out from now on is as uncertain as it was
/// contradicted.
void Estimator::spoil(Sense liar) noexcept {
  const Difference& off = votes_.told()[liar].off;
  const double way_m = spoiled_way_m(off);
  // Whose lie leads the place astray is known now, and below how far: no more need be feared.
  const bool of_place = liar != Sense::Velocity && liar != Sense::Compass &&
                        !(liar == Sense::Position && health_.by_map);
  if (of_place) differed_m_ = 0.0;
  const bool turn = off.of != Difference::Of::Way;
  double angle_rad = turn ? std::min(std::abs(off.size), kMostDoubt_rad) : 0.0;
  double place_m = 0.0;
  switch (liar) {
    case Sense::Position:
      if (health_.by_map) break;  // nothing is believed of it
      // A jump that was refused from its first word on has led nobody astray: if what it jumped
      // from was the truth.
      if (proved() && position_off_since_ && *position_off_since_ <= votes_.seen(liar) &&
          votes_.agreed_before(liar)) {
        break;
      }
      place_m = way_m;
      doubted_m_ = std::hypot(doubted_m_, way_m);
      position_off_since_.reset();
      far_off_since_.reset();
      break;
    case Sense::Velocity: {
      const double speed = std::abs(belief_.x(kScale) * tracks_.linear_mps);
      const double error_mps = turn ? 0.0 : std::abs(off.size) / std::max(0.1, off.window_s);
      angle_rad = std::max(angle_rad,
                           std::min(kMostDoubt_rad, error_mps / std::max(kLeastSpeed_mps, speed)));
      belief_.P(kScale, kScale) += kScaleDoubt * kScaleDoubt;
      velocity_.reset();
      velocity_off_since_.reset();
      break;
    }
    case Sense::Gyro:
      place_m = way_m;
      reset_state(belief_, kGyroBias, 0.0, base::rad_from_deg(params_->gyro_bias_sigma_dps));
      gyro_used_ = false;
      break;
    case Sense::Tracks:
      place_m = way_m;
      reset_state(belief_, kScale, 1.0, params_->odometry_scale_sigma);
      tracks_ = {};
      tracks_at_.reset();
      break;
    case Sense::Compass:
      angle_rad = 0.0;
      reset_state(belief_, kBias, belief_.x(kBias),
                  base::rad_from_deg(params_->compass_bias_sigma_deg));
      break;
    case Sense::Antennas:
      place_m = way_m;
      break;
  }
  if (!located_) place_m = 0.0;
  belief_.P(kEast, kEast) += place_m * place_m;
  belief_.P(kNorth, kNorth) += place_m * place_m;
  belief_.P(kYaw, kYaw) += angle_rad * angle_rad;
}

}  // namespace roverd::nav
