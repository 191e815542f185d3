#include "nav/identify/vehicle_learner.hpp"

#include <algorithm>
#include <cmath>

#include "nav/track/rules.hpp"

namespace roverd::nav {
namespace {

constexpr int kRolling = 60;  // ticks of driving before turning counts
constexpr double kRolling_mps = 0.15;
constexpr int kLook = 10;  // ticks
constexpr double kTurnSure_s = 0.015;
constexpr double kDriveSure_s = 0.02;  // less sure: limits that are not known yet look so
constexpr double kHiddenLag_s = 0.03;
constexpr double kMotorsDiffer_s = 0.05;  // speed and turn rate of the same two, 1 sigma
constexpr int kUnsure = 60;               // ticks, until a limit that was just met is the past
constexpr int kSilent = 6;                // ticks: a base that tells more seldom shows no slopes
constexpr double kUnknownDelay_s = 0.25;
constexpr double kKnownDelay_s = 0.06;
constexpr double kOfLimit = 0.92;  // of the braking that was met, to plan with
constexpr double kProved = 0.8;    // of what is planned with, shown
constexpr double kLeast_mps2 = 0.1;
constexpr double kDelayStep_s = 0.01;  // smaller changes are noise
constexpr double kBrakeStep = 0.03;    // of one
constexpr double kGentle = 0.9;        // of what the vehicle can do
constexpr double kFree = 1e3;
constexpr double kNever = -1.0;  // nothing is as gentle: it obeys somebody else

std::optional<base::LearnedNumber> number(const std::optional<DelayFound>& d) noexcept {
  if (!d) return std::nullopt;
  return base::LearnedNumber{d->delay_s, d->sigma_s};
}

std::optional<base::LearnedNumber> number(const BrakeMeter& m) noexcept {
  if (!m.limit_mps2()) return std::nullopt;
  return base::LearnedNumber{*m.limit_mps2(), m.sigma_mps2()};
}

}  // namespace

/// Steering along a line tells little of turning, and that with what disturbs it; speeding up tells
/// much, of the same motors. Where wheels are steered it tells nothing of them.
std::optional<DelayFound> VehicleLearner::delay(const PathParams& set) const noexcept {
  if (set.vehicle.steered()) return turned_ ? turned_ : recalled_;
  const auto& drive = drove_;
  if (!drive) return turned_ ? turned_ : recalled_;
  if (!turned_) return drive;
  const double drive_sigma = std::hypot(drive->sigma_s, kMotorsDiffer_s);
  const double by_turn = 1.0 / (turned_->sigma_s * turned_->sigma_s);
  const double by_drive = 1.0 / (drive_sigma * drive_sigma);
  const double sum = by_turn + by_drive;
  return DelayFound{(by_turn * turned_->delay_s + by_drive * drive->delay_s) / sum,
                    std::sqrt(1.0 / sum), turned_->gain};
}

/// No command acts later.
double VehicleLearner::longest_delay_s(const PathParams& set) const noexcept {
  if (const auto& drive = drove_) return drive->delay_s + kKnownDelay_s;
  if (const auto known = delay(set)) return known->delay_s + kKnownDelay_s;
  return set.track.delay_s + kUnknownDelay_s;
}

void VehicleLearner::see(const Seen& seen) noexcept {
  ours_ = seen.ours;
  ++heard_;
  if (seen.tracks && seen.tracks_stamp > told_) {
    speaks_ = heard_ <= kSilent;
    heard_ = 0;
    told_ = seen.tracks_stamp;
    seen_mps_ = seen.tracks->linear_mps;
    driving_.measured(seen_mps_, base::seconds(seen.now - told_), ours_);
  }
  if (seen.yaw_rate_radps && std::isfinite(*seen.yaw_rate_radps)) {
    turning_.measured(*seen.yaw_rate_radps, 0.0, ours_ && seen.turns_count && rolling_ >= kRolling);
  }
}

void VehicleLearner::sent(const base::BodyTwist& twist, const PathParams& set) noexcept {
  rolling_ =
      ours_ && std::abs(twist.linear_mps) > kRolling_mps ? std::min(rolling_ + 1, kRolling) : 0;
  const bool knew_down = braking_.limit_mps2().has_value();
  const bool knew_up = speeding_up_.limit_mps2().has_value();
  // What it can make of the command: a limit that is known is no delay.
  const double up = speeding_up_.limit_mps2().value_or(kFree) * DelayMeter::kTick_s;
  const double down = braking_.limit_mps2().value_or(kFree) * DelayMeter::kTick_s;
  can_mps_ = slew(can_mps_, twist.linear_mps, up, down);
  driving_.sent(can_mps_, ours_ && unsure_ == 0 ? kFree : kNever);
  unsure_ = std::max(0, unsure_ - 1);
  turning_.sent(twist.angular_radps, ours_ ? kGentle * set.speed.yaw_decel_radps2 : kNever);
  if (--look_ <= 0) {
    look_ = kLook;
    const auto turn = turning_.found();
    if (turn && turn->sigma_s <= kTurnSure_s) turned_ = turn;
    auto drive = driving_.found();
    if (drive && drive->sigma_s <= kDriveSure_s) {
      // At its limit the lag in front of it is half hidden.
      if (knew_down || knew_up) drive->sigma_s = std::hypot(drive->sigma_s, kHiddenLag_s);
      drove_ = drive;
    }
  }
  if (!ours_ || !speaks_ || heard_ > kSilent) {
    braking_.look_away();
    speeding_up_.look_away();
    return;
  }
  const double way = seen_mps_ < 0.0 ? -1.0 : 1.0;
  const double told = std::max(0.0, way * twist.linear_mps);
  const auto seen = heard_ == 0 ? std::optional(way * seen_mps_) : std::nullopt;
  const double delay_s = longest_delay_s(set);
  braking_.step(told, seen, delay_s);
  speeding_up_.step(told, seen, delay_s);
  // What could not be followed until now looked like a longer delay.
  if (braking_.limit_mps2().has_value() != knew_down ||
      speeding_up_.limit_mps2().has_value() != knew_up) {
    driving_.forget();
    drove_.reset();
    unsure_ = kUnsure;
  }
}

void VehicleLearner::recall(const base::VehicleLearned& known) noexcept {
  const auto sane = [](const std::optional<base::LearnedNumber>& n, double least, double most) {
    return n && n->value >= least && n->value <= most && n->sigma > 0.0;
  };
  if (sane(known.delay_s, 0.0, DelayMeter::kMost_s)) {
    recalled_ = DelayFound{known.delay_s->value, known.delay_s->sigma, 1.0};
  }
  if (sane(known.braking_mps2, 0.05, 10.0)) braking_.recall(known.braking_mps2->value);
  if (sane(known.acceleration_mps2, 0.05, 10.0)) {
    speeding_up_.recall(known.acceleration_mps2->value);
  }
}

base::VehicleLearned VehicleLearner::learned(const PathParams& set) const noexcept {
  base::VehicleLearned out;
  out.delay_s = number(delay(set));
  out.drive_delay_s = number(drove_);
  out.braking_mps2 = number(braking_);
  out.acceleration_mps2 = number(speeding_up_);
  out.braking_shown_mps2 = braking_.shown_mps2();
  out.delay_set_s = set.track.delay_s;
  out.braking_set_mps2 = set.speed.decel_mps2;
  out.acceleration_set_mps2 = set.speed.accel_mps2;
  return out;
}

base::VehicleLearned VehicleLearner::learned_now(const PathParams& set) const noexcept {
  base::VehicleLearned out = learned(set);
  if (!turned_ && !drove_) out.delay_s.reset();
  if (!braking_.looked()) out.braking_mps2.reset();
  if (!speeding_up_.looked()) out.acceleration_mps2.reset();
  return out;
}

bool VehicleLearner::handle(const PathParams& set, PathParams& use) noexcept {
  double delay_s = set.track.delay_s;
  if (const auto known = delay(set)) {
    delay_s = std::clamp(known->delay_s, 0.3 * delay_s, delay_s + 0.4);
  }
  double brake = set.speed.decel_mps2;
  if (const auto limit = braking_.limit_mps2()) {
    brake = std::clamp(kOfLimit * *limit, kLeast_mps2, brake);
  }
  double up = set.speed.accel_mps2;
  if (const auto limit = speeding_up_.limit_mps2()) {
    up = std::clamp(kOfLimit * *limit, std::min(kLeast_mps2, up), up);
  }
  const bool unproved = speaks_ && braking_.shown_mps2().value_or(0.0) < kProved * brake;
  const bool other = std::abs(delay_s - use.track.delay_s) > kDelayStep_s ||
                     std::abs(brake - use.speed.decel_mps2) > kBrakeStep * brake ||
                     std::abs(up - use.speed.accel_mps2) > kBrakeStep * up ||
                     unproved != use.prove_braking;
  if (!other) return false;
  use.track.delay_s = delay_s;
  use.speed.decel_mps2 = brake;
  use.speed.accel_mps2 = up;
  use.prove_braking = unproved;
  return true;
}

}  // namespace roverd::nav
