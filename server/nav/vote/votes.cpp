#include "nav/vote/votes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

using base::EnuPoint;
using base::rad_from_deg;
using base::seconds;

constexpr double kGyroGap_s = 0.1;
constexpr double kTracksGap_s = 0.5;
constexpr double kPaceGap_s = 1.2;
constexpr double kSpotGap_s = 3.0;
constexpr double kBearingEvery_s = 0.15;
constexpr double kSlowest_mps = 0.3;  // below, a velocity has no course worth comparing
constexpr double kChord_s = 2.0;
constexpr double kChordLeast_m = 0.4;
const double kChordBend_rad = rad_from_deg(25.0);
constexpr double kPathLeast_m = 0.03;
constexpr double kStraight = 0.9;  // of the tracks' way goes one way
constexpr double kCourseLate_s = 0.05;
constexpr double kFrozen_s = 1.0;
constexpr int kFrozenTimes = 5;
constexpr double kFrozenMoved_m = 0.5;
constexpr double kFrozenTurned_rad = 0.2;
constexpr double kFrozenSpeed_mps = 0.1;
constexpr double kLookAnyway_s = 1.2;
constexpr double kPivotRate_radps = 0.25;
constexpr double kPivotSpeed_mps = 0.15;
constexpr double kPivotCentre_m = 0.15;  // by which a skid steer's wanders
constexpr double kSwing = 0.5;           // of the speed, at most: more, and a course tells nothing
constexpr double kApartForgotten_s = 1.0;
constexpr double kScatterShare = 0.05;  // of one more velocity
constexpr double kGoesAlong = 0.6;      // of the limit by which position and velocity may differ

double bearing_of(EnuPoint way) noexcept {
  return std::atan2(way.north_m, way.east_m);
}

/// What is known by other means than a limit. @param ratio > 1: it is beyond it.
Finding proved(const Difference& off, double ratio) noexcept {
  Finding x;
  x.judged = true;
  x.off = off;
  x.way_off_m = off.size;
  x.limit = off.size / std::max(1.001, ratio);
  return x;
}

}  // namespace

void Votes::say(Sense s, double a, double b, Time stamp) noexcept {
  heard_[index_of(s)] = stamp;
  Repeats& r = repeats_[index_of(s)];
  if (!r.since || r.a != a || r.b != b) {
    r = {a, b, 0, stamp, sums_.path_m, all_turned_rad_};
  }
  ++r.times;
}

/// The same again and again, while the tracks went on or turned.
bool Votes::frozen(Sense s, Time now) const noexcept {
  const Repeats& r = repeats_[index_of(s)];
  if (s == Sense::Tracks || !r.since) return false;
  const bool same = r.times >= kFrozenTimes && seconds(now - *r.since) >= kFrozen_s;
  if (jury_.stuck(s)) return same;
  if (!same) return false;
  const bool went = sums_.path_m - r.path_m > kFrozenMoved_m;
  const bool turned = all_turned_rad_ - r.turn_rad > kFrozenTurned_rad;
  if (s == Sense::Position) return went;
  // On the spot it stands, and its velocity stays nothing.
  const bool stands = s == Sense::Velocity && std::hypot(r.a, r.b) < kFrozenSpeed_mps;
  return stands ? went : turned;
}

void Votes::tracks(double ahead_m, double turn_rad, Time stamp) noexcept {
  const auto before = heard_[index_of(Sense::Tracks)];
  if (!before || seconds(stamp - *before) > kTracksGap_s) ++sums_.track_run;
  count(ahead_m, turn_rad);
  say(Sense::Tracks, ahead_m, turn_rad, stamp);
}

void Votes::told_to(double ahead_m, double turn_rad) noexcept {
  count(ahead_m, turn_rad);
}

void Votes::count(double ahead_m, double turn_rad) noexcept {
  sums_.ahead_m += ahead_m;
  sums_.path_m += std::abs(ahead_m);
  sums_.turn_rad += turn_rad;
  all_turned_rad_ += std::abs(turn_rad);
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

void Votes::velocity(EnuPoint mps, double sigma_mps, Time taken, Time stamp,
                     double slower_than_mps) noexcept {
  Pace p{taken, mps, std::max(sigma_mps, scatter_mps(mps)), {}, 0, 0.2, slower_than_mps, 0.0};
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
    p.vague_m = last.vague_m + 0.5 * dt_s * (last.slower_than_mps + slower_than_mps);
  }
  all.push(p);
  say(Sense::Velocity, mps.east_m, mps.north_m, stamp);
  course_of(p);
}

/// How much velocities differ from the line through the two before: a receiver that tells no
/// accuracy is as good as that.
double Votes::scatter_mps(EnuPoint mps) noexcept {
  const auto& all = facts_.paces;
  if (all.size() >= 2) {
    const EnuPoint bend = mps - all[0].mps - (all[0].mps - all[1].mps);
    const double square = (bend.east_m * bend.east_m + bend.north_m * bend.north_m) / 12.0;
    scatter_m2ps2_ += kScatterShare * (square - scatter_m2ps2_);
  }
  return std::sqrt(scatter_m2ps2_);
}

void Votes::heading(Sense s, double yaw_rad, double sigma_rad, Time taken, Time stamp) noexcept {
  say(s, yaw_rad, 0.0, stamp);
  if (const auto at = facts_.curve.at(taken)) {
    bear(s, yaw_rad, {taken, 0.0, sigma_rad, 0.0}, at->ref_rad);
  }
}

void Votes::bear(Sense s, double yaw_rad, const Bearing& about, double ref_rad) noexcept {
  Bearings& all = facts_.bearings[index_of(s)];
  if (!all.empty() && seconds(about.t - all.newest().t) < kBearingEvery_s) return;
  const double last = all.empty() ? 0.0 : all.newest().off_rad;
  const double off = last + base::angle_diff_rad(last, yaw_rad - ref_rad);
  all.push({about.t, off, about.sigma_rad, about.bias_rad});
}

/// Either forth or back, and told at all. What nobody ever told of drives forth.
bool Votes::one_way(double path_m, double ahead_m) const noexcept {
  if (sums_.path_m <= 0.0) return true;
  return path_m > kPathLeast_m && std::abs(ahead_m) >= kStraight * path_m;
}

/// Whether it drove forth or back is known, or never told at all.
bool Votes::way_known(const Moment& from, const Moment& to) const noexcept {
  const auto& heard = heard_[index_of(Sense::Tracks)];
  if (!heard) return true;
  return from.track_run == to.track_run && seconds(to.t - *heard) < kTracksLate_s;
}

/// How far it turned at least by tracks and reference, either way: one of them may lie.
double Votes::turned_rad(const Moment& from, const Moment& to) const noexcept {
  const double by_ref = std::abs(to.ref_rad - from.ref_rad);
  if (!heard_[index_of(Sense::Tracks)]) return by_ref;
  return std::min(by_ref, std::abs(to.turn_rad - from.turn_rad));
}

/// Backwards, a vehicle points the other way.
void Votes::course_of(const Pace& pace) noexcept {
  const double speed = std::hypot(pace.mps.east_m, pace.mps.north_m);
  if (speed < std::max(kSlowest_mps, 3.0 * pace.sigma_mps)) return;
  const auto at = facts_.curve.at(pace.t);
  // What a base was told it does later.
  const double lately_s = heard_[index_of(Sense::Tracks)] ? 0.3 : 1.5;
  const auto before = facts_.curve.at(pace.t - base::from_seconds(lately_s));
  if (!at || !before || !way_known(*before, *at)) return;
  const double path_m = at->path_m - before->path_m;
  const double ahead_m = at->ahead_m - before->ahead_m;
  if (!one_way(path_m, ahead_m)) return;
  const double back = ahead_m < 0.0 ? base::kPi : 0.0;
  const double rate = turned_rad(*before, *at) / lately_s;
  const double swing = facts_.arm_m * rate / speed;
  if (swing > kSwing) return;
  bear(Sense::Velocity, bearing_of(pace.mps) + back,
       {pace.t, 0.0, pace.sigma_mps / speed, std::hypot(kCourseLate_s * rate, swing)}, at->ref_rad);
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
  if (!from || !to || !at || !way_known(*from, *to)) return;
  const double path_m = to->path_m - from->path_m;
  const double ahead_m = to->ahead_m - from->ahead_m;
  if (!one_way(path_m, ahead_m)) return;
  // Round an even bend a chord points where the middle does; round an uneven one it does not.
  const double first_rad = at->ref_rad - from->ref_rad;
  const double second_rad = to->ref_rad - at->ref_rad;
  const double uneven_rad = 0.25 * std::abs(second_rad - first_rad);
  const double bend = std::abs(first_rad) + std::abs(second_rad);
  if (bend > kChordBend_rad) return;
  const double back = ahead_m < 0.0 ? base::kPi : 0.0;
  const double drift_m =
      b.drift_m * std::sqrt(-2.0 * std::expm1(-seconds(b.t - a.t) / std::max(1.0, b.drift_s)));
  const double sigma = std::hypot(std::hypot(a.sigma_m, b.sigma_m, drift_m) / chord_m, 0.1 * bend);
  if (sigma > rad_from_deg(15.0)) return;
  const double swing = facts_.arm_m * turned_rad(*from, *to) / chord_m;
  if (swing > kSwing) return;
  bear(Sense::Position, bearing_of(chord) + back,
       {middle, 0.0, sigma, std::hypot(swing, uneven_rad)}, at->ref_rad);
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

void Votes::look_for_run_off(const Table& table, Time now) noexcept {
  const Spot& spot = facts_.spots.newest();
  const auto at = facts_.curve.at(spot.t);
  const bool told = facts_.tracks_at && seconds(spot.t - *facts_.tracks_at) <= kTracksLate_s;
  const auto trusted = [&](Sense s) { return facts_.heard[index_of(s)] && !jury_.out(s); };
  const bool judgeable =
      facts_.rtk && at && told && !table.spins && gyro_leads(now) && trusted(Sense::Tracks);
  run_off_.look({.spot = spot,
                 .at = at.value_or(Moment{}),
                 .arm = belief_.arm,
                 .downhill = belief_.downhill,
                 .doubt = belief_.downhill_sigma,
                 .judgeable = judgeable});
}

void Votes::tell_run_off(Table& table) const noexcept {
  if (run_off_.proved() < 1.0) return;
  // One that repeats itself is known to be the one; and a velocity that stays behind tells who is
  // wrong, by other rules.
  if (repeats_[index_of(Sense::Position)].times > 1) return;
  if (table.between(Sense::Position, Sense::Velocity).ratio() > kGoesAlong) return;
  table.runs_off = true;
  const Difference off = run_off_.off();
  table.put(Sense::Tracks, Sense::Position, proved(off, run_off_.proved()));
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
  sums_.pull_1pm = b.pull_1pm;
  sums_.pull_sigma_1pm = b.pull_sigma_1pm;
  facts_.gyro_bias_sigma_radps = b.gyro_bias_sigma_radps;
  facts_.arm_m = b.arm_m + kPivotCentre_m;
  facts_.curve.push(sums_);
  // In the step after the one that took it: both are dear, and a tick has one of them.
  const bool just_came = spot_is_new_ && !std::exchange(spot_waited_, true);
  // One bad position is one look, however seldom they come.
  const double since_s = looked_ ? seconds(now - *looked_) : 1e9;
  if (since_s < Jury::kEvery_s || (!spot_is_new_ && since_s < kLookAnyway_s && spots_come(now))) {
    return std::nullopt;
  }
  if (just_came) return std::nullopt;
  looked_ = now;
  facts_.tracks_at = heard_[index_of(Sense::Tracks)];
  std::array<bool, kSenses> frozen_now{};
  for (std::size_t i = 0; i < kSenses; ++i) {
    facts_.heard[i] = heard_[i] && seconds(now - *heard_[i]) < kSilent_s;
    facts_.from[i] = jury_.from(static_cast<Sense>(i));
    frozen_now[i] = frozen(static_cast<Sense>(i), now);
  }
  Table table = compare(facts_, sigmas);
  table.unproved = facts_.rtk && !b.positions_proved;
  if (table.spins) facts_.spun = now;
  if (spot_is_new_) look_for_run_off(table, now);
  spot_is_new_ = spot_waited_ = false;
  tell_run_off(table);
  apart_ = table.apart.value_or(apart_ * std::exp(-since_s / kApartForgotten_s));
  return jury_.step(table, facts_.heard, frozen_now, return_s, now);
}

}  // namespace roverd::nav
