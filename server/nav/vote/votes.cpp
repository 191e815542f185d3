#include "nav/vote/votes.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

using base::EnuPoint;
using base::rad_from_deg;
using base::seconds;

constexpr double kGyroGap_s = 0.1;
constexpr double kPaceGap_s = 1.2;
constexpr double kSpotGap_s = 3.0;
constexpr double kBearingEvery_s = 0.09;
constexpr double kSlowest_mps = 0.3;  // below, a velocity has no course worth comparing
constexpr double kChord_s = 2.0;
constexpr double kChordLeast_m = 0.4;
const double kChordBend_rad = rad_from_deg(25.0);
constexpr double kStraight = 0.9;  // of the tracks' way goes one way
constexpr double kCourseLate_s = 0.05;
constexpr double kFrozen_s = 1.0;
constexpr int kFrozenTimes = 5;
constexpr double kFrozenMoved_m = 0.5;
constexpr double kLookAnyway_s = 1.2;
constexpr double kPivotRate_radps = 0.25;
constexpr double kPivotSpeed_mps = 0.15;

double bearing_of(EnuPoint way) noexcept {
  return std::atan2(way.north_m, way.east_m);
}

}  // namespace

void Votes::say(Sense s, double a, double b, Time stamp) noexcept {
  heard_[index_of(s)] = stamp;
  Repeats& r = repeats_[index_of(s)];
  if (!r.since || r.a != a || r.b != b) {
    r = {a, b, 0, stamp, sums_.path_m, turned_m_};
  }
  ++r.times;
}

/// The same again and again, while the tracks went on or turned.
bool Votes::frozen(Sense s, Time now) const noexcept {
  const Repeats& r = repeats_[index_of(s)];
  if (s == Sense::Tracks || !r.since) return false;
  const bool same = r.times >= kFrozenTimes && seconds(now - *r.since) >= kFrozen_s;
  if (jury_.out(s)) return same;  // it must show life
  return same && (s == Sense::Position ? sums_.path_m - r.path_m > kFrozenMoved_m
                                       : turned_m_ - r.turn_rad > 0.2);
}

void Votes::tracks(double ahead_m, double turn_rad, Time stamp) noexcept {
  sums_.ahead_m += ahead_m;
  sums_.path_m += std::abs(ahead_m);
  sums_.turn_rad += turn_rad;
  turned_m_ += std::abs(turn_rad);
  say(Sense::Tracks, ahead_m, turn_rad, stamp);
}

void Votes::gyro(double rate_radps, double raw, Time stamp) noexcept {
  const auto before = heard_[index_of(Sense::Gyro)];
  const double dt_s = before ? seconds(stamp - *before) : 1e9;
  if (dt_s > kGyroGap_s) {
    ++sums_.gyro_run;
  } else {
    sums_.gyro_rad += 0.5 * (gyro_rate_radps_ + rate_radps) * dt_s;
  }
  gyro_rate_radps_ = rate_radps;
  say(Sense::Gyro, raw, 0.0, stamp);
}

void Votes::position(const Spot& spot, int fix_class, Time stamp) noexcept {
  Spot s = spot;
  auto& all = facts_.spots;
  s.run = all.empty() ? 0 : all.newest().run;
  if (!all.empty() && s.t <= all.newest().t) return;
  const bool gap = !all.empty() && seconds(s.t - all.newest().t) > kSpotGap_s;
  if (gap || fix_class_ != fix_class) ++s.run;
  fix_class_ = fix_class;
  facts_.rtk = spot.drift_m <= 0.0;
  all.push(s);
  spot_is_new_ = true;
  say(Sense::Position, s.at.east_m, s.at.north_m, stamp);
  course_of_spots();
}

void Votes::velocity(EnuPoint mps, double sigma_mps, Time taken, Time stamp) noexcept {
  Pace p{taken, mps, sigma_mps, {}, 0, 0.2};
  auto& all = facts_.paces;
  if (!all.empty()) {
    const Pace& last = all.newest();
    const double dt_s = seconds(taken - last.t);
    if (dt_s <= 0.0) return;
    p.run = last.run + (dt_s > kPaceGap_s ? 1 : 0);
    p.every_s = std::clamp(dt_s, 0.1, kPaceGap_s);
    const EnuPoint sum = last.mps + mps;
    p.sum_m = {last.sum_m.east_m + 0.5 * dt_s * sum.east_m,
               last.sum_m.north_m + 0.5 * dt_s * sum.north_m};
  }
  all.push(p);
  say(Sense::Velocity, mps.east_m, mps.north_m, stamp);
  course_of(p);
}

void Votes::heading(Sense s, double yaw_rad, double sigma_rad, Time taken, Time stamp) noexcept {
  say(s, yaw_rad, 0.0, stamp);
  if (const auto at = facts_.curve.at(taken)) bear(s, yaw_rad, sigma_rad, taken, at->ref_rad);
}

void Votes::bear(Sense s, double yaw_rad, double sigma_rad, Time taken, double ref_rad) noexcept {
  Bearings& all = facts_.bearings[index_of(s)];
  if (!all.empty() && seconds(taken - all.newest().t) < kBearingEvery_s) return;
  const double last = all.empty() ? 0.0 : all.newest().off_rad;
  const double off = last + base::angle_diff_rad(last, yaw_rad - ref_rad);
  all.push({taken, off, sigma_rad});
}

/// Backwards, a vehicle points the other way.
void Votes::course_of(const Pace& pace) noexcept {
  const double speed = std::hypot(pace.mps.east_m, pace.mps.north_m);
  if (speed < std::max(kSlowest_mps, 3.0 * pace.sigma_mps)) return;
  const auto at = facts_.curve.at(pace.t);
  const auto before = facts_.curve.at(pace.t - base::from_seconds(0.3));
  if (!at || !before) return;
  const double path_m = at->path_m - before->path_m;
  const double ahead_m = at->ahead_m - before->ahead_m;
  const bool counts = path_m > 0.01;
  if (counts && std::abs(ahead_m) < kStraight * path_m) return;
  const double back = counts && ahead_m < 0.0 ? base::kPi : 0.0;
  const double rate = std::abs(at->ref_rad - before->ref_rad) / 0.3;
  const double sigma = std::hypot(pace.sigma_mps / speed, kCourseLate_s * rate,
                                  facts_.arm_m * std::min(rate, 1.0) / speed);
  bear(Sense::Velocity, bearing_of(pace.mps) + back, sigma, pace.t, at->ref_rad);
}

void Votes::course_of_spots() noexcept {
  const auto& all = facts_.spots;
  const Spot& b = all.newest();
  const std::size_t i = all.not_after(b.t - base::from_seconds(kChord_s));
  if (i >= all.size() || all[i].run != b.run) return;
  const Spot& a = all[i];
  const EnuPoint chord = b.at - a.at;
  const double chord_m = std::hypot(chord.east_m, chord.north_m);
  if (chord_m < std::max(kChordLeast_m, 4.0 * b.sigma_m)) return;
  const Time middle = a.t + (b.t - a.t) / 2;
  const auto from = facts_.curve.at(a.t);
  const auto to = facts_.curve.at(b.t);
  const auto at = facts_.curve.at(middle);
  if (!from || !to || !at) return;
  const double path_m = to->path_m - from->path_m;
  const double ahead_m = to->ahead_m - from->ahead_m;
  const bool counts = path_m > 0.05;
  if (counts && std::abs(ahead_m) < kStraight * path_m) return;
  const double bend = std::abs(to->ref_rad - from->ref_rad);
  if (bend > kChordBend_rad) return;
  const double back = counts && ahead_m < 0.0 ? base::kPi : 0.0;
  const double drift_m =
      b.drift_m * std::sqrt(-2.0 * std::expm1(-seconds(b.t - a.t) / std::max(1.0, b.drift_s)));
  const double sigma = std::hypot(std::hypot(a.sigma_m, b.sigma_m, drift_m) / chord_m, 0.1 * bend);
  if (sigma > rad_from_deg(15.0)) return;
  bear(Sense::Position, bearing_of(chord) + back, sigma, middle, at->ref_rad);
}

bool Votes::gyro_leads(Time now) const noexcept {
  const auto& heard = heard_[index_of(Sense::Gyro)];
  return heard && seconds(now - *heard) < kGyroGap_s && !jury_.out(Sense::Gyro);
}

/// The curve's reference goes on by the gyro, or by the tracks where there is none.
void Votes::follow_reference(Time now) noexcept {
  const bool gyro = gyro_leads(now);
  if (gyro != led_by_gyro_) {
    led_by_gyro_ = gyro;
    ++sums_.ref_run;
    for (Bearings& b : facts_.bearings) b.clear();
  }
  const double turned = gyro ? sums_.gyro_rad - dead_gyro_rad_
                             : belief_.yaw_scale * (sums_.turn_rad - dead_turn_rad_);
  const double ahead_m = sums_.ahead_m - dead_ahead_m_;
  const double middle = sums_.ref_rad + 0.5 * turned;
  sums_.x_m += ahead_m * std::cos(middle);
  sums_.y_m += ahead_m * std::sin(middle);
  sums_.ref_rad += turned;
  dead_gyro_rad_ = sums_.gyro_rad;
  dead_turn_rad_ = sums_.turn_rad;
  dead_ahead_m_ = sums_.ahead_m;
  const auto before = facts_.curve.at(now - base::from_seconds(0.2));
  if (!before) return;
  const double rate = std::abs(sums_.ref_rad - before->ref_rad) / 0.2;
  const double speed = std::abs(sums_.ahead_m - before->ahead_m) / 0.2;
  if (rate > kPivotRate_radps && speed < kPivotSpeed_mps) facts_.pivoted = now;
}

bool Votes::spots_come(Time now) const noexcept {
  const auto& heard = heard_[index_of(Sense::Position)];
  return heard && seconds(now - *heard) < kLookAnyway_s;
}

std::optional<Sense> Votes::step(const Belonging& b, double sigmas, double return_s,
                                 Time now) noexcept {
  belief_ = b;
  follow_reference(now);
  sums_.t = now;
  sums_.yaw_rad = b.yaw_rad;
  sums_.yaw_sigma_rad = b.yaw_sigma_rad;
  sums_.scale = b.scale;
  sums_.scale_sigma = b.scale_sigma;
  facts_.gyro_bias_sigma_radps = b.gyro_bias_sigma_radps;
  facts_.arm_m = b.arm_m;
  facts_.curve.push(sums_);
  // One bad position is one look, however seldom they come.
  const double since_s = looked_ ? seconds(now - *looked_) : 1e9;
  if (since_s < Jury::kEvery_s || (!spot_is_new_ && since_s < kLookAnyway_s && spots_come(now))) {
    return std::nullopt;
  }
  looked_ = now;
  spot_is_new_ = false;
  std::array<bool, kSenses> frozen_now{};
  for (std::size_t i = 0; i < kSenses; ++i) {
    facts_.heard[i] = heard_[i] && seconds(now - *heard_[i]) < kSilent_s;
    facts_.from[i] = jury_.from(static_cast<Sense>(i));
    frozen_now[i] = frozen(static_cast<Sense>(i), now);
  }
  return jury_.step(compare(facts_, sigmas), facts_.heard, frozen_now, return_s, now);
}

}  // namespace roverd::nav
