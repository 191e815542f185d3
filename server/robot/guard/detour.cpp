#include "robot/guard/detour.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"

namespace roverd::robot {
namespace {

using nav::around::Place;

constexpr base::Duration kLost = std::chrono::seconds(5);  // a question nobody answers
constexpr base::Duration kOfNow = std::chrono::milliseconds(1500);
constexpr base::Duration kLeft = std::chrono::milliseconds(500);
constexpr double kSameBend_1pm = 0.02;
constexpr double kHand_m = 0.12;
constexpr double kLook_m = 0.2;
constexpr double kShorter = 0.8;
constexpr double kArc_m = 0.25;
constexpr double kTurn_radps = 0.4;
constexpr double kElsewhere_m = 0.3;
constexpr double kAtRest_mps = 0.02;
constexpr double kNear_m = 0.1;    // of a first place, for one that stands
constexpr double kLead_m = 0.25;   // and for one that stops first
constexpr double kJoins_s = 2.2;   // ahead of one that drives on
constexpr double kAside_m = 0.05;  // of the straight way there
constexpr double kPassed_m = 0.8;  // farther it does not come before an answer is too old

bool same_piece(const Place& a, const Place& b) noexcept {
  return a.reverse == b.reverse && !a.pivot && !b.pivot &&
         std::abs(a.curvature_1pm - b.curvature_1pm) < kSameBend_1pm;
}

base::EnuPoint place_in(const nav::sense::Pose2& odometry_in_local, const Place& p) noexcept {
  const auto at = odometry_in_local * p.pose;
  return {at.x_m, at.y_m};
}

/// An answer begins where the robot was when it was asked for. @return the place before the first
/// one that it can drive to from where it is: not one that lies behind it by now, nor one so near
/// that a centimetre of error would turn it to somewhere else
std::size_t joins_at(const AroundAnswer& answer, const nav::Vehicle& vehicle) {
  const std::vector<Place>& path = answer.found.path;
  if (path.size() < 2) return 0;
  const auto back = nav::sense::inverse(answer.asked->local);
  const auto far_m = [&](std::size_t i) {
    return base::distance_m(vehicle.at, place_in(back, path[i]));
  };
  const auto step_m = [&](std::size_t i) {
    return std::hypot(path[i].pose.x_m - path[i - 1].pose.x_m,
                      path[i].pose.y_m - path[i - 1].pose.y_m);
  };
  std::size_t first = 1;  // that is driven to; turns before it have no place of their own
  while (first + 1 < path.size() && path[first].pivot) ++first;
  std::size_t end = first;  // of those that are driven to without turning round
  for (double way_m = 0.0; end < path.size() && way_m < kPassed_m; ++end) {
    if (path[end].pivot || path[end].reverse != path[first].reverse) break;
    way_m += step_m(end);
  }
  std::size_t best = first - 1;
  for (std::size_t i = first; i + 1 < end; ++i) {
    if (far_m(i) < far_m(best)) best = i;
  }
  const auto beyond = [&](double lead_m) {
    std::size_t at = best;
    while (at + 2 < end && far_m(at + 1) < lead_m) ++at;
    return at;
  };
  const double v_mps = std::abs(vehicle.speed_mps);
  if (v_mps < kAtRest_mps) return beyond(kNear_m);
  // So far ahead that it need not stop, where the way there is as good as straight.
  const std::size_t on = beyond(kJoins_s * v_mps);
  const base::EnuPoint there = place_in(back, path[on + 1]);
  const base::EnuPoint line = there - vehicle.at;
  for (std::size_t i = best + 1; i <= on; ++i) {
    const base::EnuPoint off = place_in(back, path[i]) - vehicle.at;
    const double aside_m = std::abs(line.east_m * off.north_m - line.north_m * off.east_m) /
                           std::max(kNear_m, std::hypot(line.east_m, line.north_m));
    if (aside_m > kAside_m) return beyond(kLead_m);
  }
  return std::max(on, beyond(kLead_m));
}

}  // namespace

std::vector<nav::Vertex> way_of(const AroundAnswer& answer, double speed_mps, std::size_t from) {
  const std::vector<Place>& path = answer.found.path;
  const auto back = nav::sense::inverse(answer.asked->local);
  std::vector<nav::Vertex> out;
  double since_m = 0.0;
  for (std::size_t i = from + 1; i < path.size(); ++i) {
    const Place& p = path[i];
    if (p.pivot) continue;
    const bool last = i + 1 == path.size();
    // Bends of one kind are one arc. Not long ones: whoever begins in the middle of one goes
    // straight to its end.
    since_m += std::hypot(p.pose.x_m - path[i - 1].pose.x_m, p.pose.y_m - path[i - 1].pose.y_m);
    const bool joins = !out.empty() && since_m < kArc_m;
    if (!last && joins && same_piece(p, path[i + 1])) continue;
    since_m = 0.0;
    const bool turns = !last && (path[i + 1].pivot || path[i + 1].reverse != p.reverse);
    nav::Vertex v;
    v.at = place_in(back, p);
    v.speed_mps = speed_mps;
    v.reverse = p.reverse;
    v.stop = last || turns;
    // As it was found: bent onto the way beyond, it would come nearer to what stands there.
    if (!last && path[i + 1].pivot) v.turn = mission::Turn::Pivot;
    v.deviation_m = 0.02;
    v.tangent = !v.stop;
    v.curvature_1pm = out.empty() ? 0.0 : p.curvature_1pm;
    out.push_back(v);
  }
  return out;
}

bool Detour::may_ask(base::Time now) const noexcept {
  if (open_) return now - asked_at_ > kLost;
  return asked_ == 0 || now - asked_at_ >= kAskEvery;
}

std::uint64_t Detour::asks(base::Time now) noexcept {
  open_ = true;
  asked_at_ = now;
  return ++asked_;
}

std::vector<Place> Detour::rest(const nav::sense::Pose2& local) const {
  std::vector<Place> out;
  if (!answer_ || turns_) return out;
  const nav::Path& path = trip_.path();
  const auto move = local * nav::sense::inverse(answer_->asked->local);
  const base::EnuPoint here = path.at(trip_.s_m());
  const auto back = nav::sense::inverse(answer_->asked->local);
  const auto& all = answer_->found.path;
  // The nearest place of those found is where the rest begins.
  std::size_t from = 0;
  double least_m = 1e9;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double far_m = base::distance_m(here, place_in(back, all[i]));
    if (far_m < least_m) {
      least_m = far_m;
      from = i;
    }
  }
  for (std::size_t i = from; i < all.size(); ++i) {
    Place p = all[i];
    p.pose = move * p.pose;
    out.push_back(p);
  }
  return out;
}

/// What is driven is kept: each change costs a look around. Another way counts where this one ends
/// at the edge of what was seen, or leads into what came to be seen, or is longer by a quarter.
bool Detour::worth(const AroundAnswer& answer, const std::vector<nav::Vertex>& way) const noexcept {
  // From where it is held, also the same way may be begun otherwise.
  if (held_) return true;
  if (same_way(way)) return false;
  const bool part = answer_->found.found == nav::around::Found::Part;
  const bool fence = answer.asked->fence_id != answer_->asked->fence_id;
  if (part || fence || !answer.before_holds) return true;
  const double rest_m = trip_.path().length_m() - trip_.s_m();
  return answer.found.found == nav::around::Found::Way && answer.found.length_m < kShorter * rest_m;
}

/// Nowhere farther than a hand's breadth from what is driven already, and no longer.
bool Detour::same_way(const std::vector<nav::Vertex>& way) const noexcept {
  const nav::Path& path = trip_.path();
  if (path.points.empty() || way.empty()) return false;
  const auto near = [&](base::EnuPoint p) {
    for (double s_m = trip_.s_m(); s_m < path.length_m() + kLook_m; s_m += kHand_m) {
      if (base::distance_m(path.at(std::min(s_m, path.length_m())), p) < 1.5 * kHand_m) return true;
    }
    return false;
  };
  return std::all_of(way.begin(), way.end(), [&](const nav::Vertex& v) { return near(v.at); }) &&
         base::distance_m(way.back().at, path.points.back().at) < 2.0 * kHand_m;
}

bool Detour::answers(const AroundAnswer& answer, base::Time now) const noexcept {
  return open_ && answer.asked->id == asked_ && now - asked_at_ < kOfNow;
}

Detour::Taken Detour::take(std::shared_ptr<const AroundAnswer> answer, const nav::Vehicle& vehicle,
                           double speed_mps) {
  open_ = false;
  using nav::around::Found;
  if (answer->found.found != Found::Way && answer->found.found != Found::Part) return Taken::Left;
  std::vector<nav::Vertex> way = way_of(*answer, speed_mps, joins_at(*answer, vehicle));
  const bool drove = drives();
  if (way.empty()) return drove && trip_.busy() ? Taken::Left : turn(std::move(answer), vehicle);
  if (drove && !turns_ && trip_.busy() && !worth(*answer, way)) return Taken::Left;
  const bool turned = std::exchange(turns_, false);
  const bool again = drove && !turned && same_way(way);
  const bool moves = std::abs(vehicle.speed_mps) >= kAtRest_mps;
  stopped_ = held_ = false;
  turned_at_.reset();
  answer_ = std::move(answer);
  nav::Trip::Order order;
  order.way = std::move(way);
  order.turns_first = answer_->found.path[1].pivot;
  trip_.begin(std::move(order), vehicle, drove && moves);
  if (again) return Taken::Again;
  return drove && !turned ? Taken::Adopted : Taken::Begun;
}

/// To see more: as far as all is seen, the way only turns.
Detour::Taken Detour::turn(std::shared_ptr<const AroundAnswer> answer,
                           const nav::Vehicle& vehicle) {
  const bool again = turned_at_ && base::distance_m(*turned_at_, vehicle.at) < kElsewhere_m;
  if (again || answer->found.path.empty()) return Taken::Useless;
  const bool drove = drives();
  stopped_ = held_ = false;
  turns_ = true;
  turned_at_ = vehicle.at;
  nav::Trip::Order order;
  const auto back = nav::sense::inverse(answer->asked->local);
  order.face_yaw_rad = (back * answer->found.path.back().pose).yaw_rad;
  order.turn_radps = kTurn_radps;
  answer_ = std::move(answer);
  trip_.begin(std::move(order), vehicle, false);
  return drove ? Taken::Adopted : Taken::Begun;
}

nav::TrackOutput Detour::step(const nav::Vehicle& vehicle, double limit_mps, base::Time now,
                              double dt_s) {
  stepped_at_ = now;
  return trip_.step(vehicle, limit_mps, dt_s);
}

void Detour::interrupt(base::Time now) noexcept {
  stepped_at_ = now;
  trip_.interrupt();
  stopped_ = held_ = true;
}

void Detour::reset() noexcept {
  stopped_ = held_ = turns_ = false;
  answer_.reset();
  trip_.reset();
  open_ = false;
  ++asked_;  // what is still being answered is not for now
}

void Detour::begin_anew() noexcept {
  reset();
  turned_at_.reset();
}

bool Detour::left_alone(base::Time now) const noexcept {
  return drives() && now - stepped_at_ > kLeft;
}

}  // namespace roverd::robot
