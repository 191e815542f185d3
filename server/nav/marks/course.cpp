#include "nav/marks/course.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace roverd::nav::marks {
namespace {

constexpr double kBackwards = -0.17;  ///< cos 100°: a chain turns no sharper
constexpr double kBegan_m = 1.0;
constexpr double kTooNear = 0.9;  ///< of the offset
constexpr double kAbeam = 0.17;   ///< cos 80°
constexpr double kMoved_m = 0.05;

Vec2 towards(Vec2 from, Vec2 to) noexcept {
  return (1.0 / std::max(1e-9, length(to - from))) * (to - from);
}

/// Along the straight from there that passes it at the offset, as landmark_way() lays it.
Vec2 past(Vec2 from, Vec2 at, double sign, double offset_m) noexcept {
  const Vec2 to = at - from;
  const double off_rad = std::asin(std::min(1.0, offset_m / std::max(1e-9, length(to))));
  const double yaw_rad = std::atan2(to.y, to.x) - sign * off_rad;
  return {std::cos(yaw_rad), std::sin(yaw_rad)};
}

}  // namespace

void Course::begin(const Pose2& pose) {
  passed_.clear();
  eyes_ = 0;
  count_ = 0;
  go_on(pose);
}

void Course::go_on(const Pose2& pose) {
  first_.reset();
  if (!passed_.empty()) eyes_ = passed_.back().eyes;
  began_here_ = true;
  behind_ = {placed(pose, {-kBegan_m, 0.0}), placed(pose, {0.0, 0.0})};
}

Eyes Course::eyes(std::span<const Landmark> known) const noexcept {
  const auto first = std::ranges::find_if(known, [&](const Landmark& l) { return l.id == first_; });
  return first == known.end() ? eyes_ : first->eyes;
}

bool Course::was_passed(const Landmark& l, double near_m) const noexcept {
  return std::ranges::any_of(
      passed_, [&](const Landmark& p) { return p.id == l.id || length(p.at - l.at) < near_m; });
}

std::vector<Landmark> Course::chain_from(std::span<const Landmark> known, Vec2 here, Vec2 ahead,
                                         const std::string& name,
                                         const LandmarkParams& params) const {
  std::vector<Landmark> left;
  for (const Landmark& l : known) {
    const bool named = name.empty() || l.name == name;
    if (l.believed && named && !was_passed(l, params.near_m)) left.push_back(l);
  }
  std::vector<Landmark> chain;
  while (chain.size() < kAhead) {
    std::size_t best = left.size();
    double least_m = params.max_range_m;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const double far_m = length(left[i].at - here);
      // The one that is just being passed is behind the vehicle before it is behind its way.
      const bool passing = chain.empty() && left[i].id == first_ && far_m < 2.0 * params.offset_m;
      const bool is_ahead = sense::dot(towards(here, left[i].at), ahead) > kBackwards;
      if (far_m >= least_m || !(is_ahead || passing)) continue;
      best = i;
      least_m = far_m;
    }
    if (best == left.size()) break;
    ahead = towards(here, left[best].at);
    here = left[best].at;
    chain.push_back(left[best]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return chain;
}

void Course::pass(const Landmark& l, Vec2 at, Vec2 out) {
  passed_.push_back(l);
  eyes_ = l.eyes;
  if (passed_.size() > kPassed) passed_.pop_front();
  ++count_;
  began_here_ = false;
  behind_ = {at - kBegan_m * out, at};
}

Way Course::lay(std::span<const Landmark> known, const Pose2& pose, Side side,
                const std::string& name, double speed_mps, const LandmarkParams& params) {
  const Vec2 here{pose.x_m, pose.y_m};
  const Vec2 heading{std::cos(pose.yaw_rad), std::sin(pose.yaw_rad)};
  const double sign = side == Side::Left ? 1.0 : -1.0;
  auto chain = chain_from(known, here, heading, name, params);
  too_near_m_.reset();
  if (!chain.empty() && began_here_ && chain[0].id != first_) {
    // No way leads from here to its passing point but backwards.
    const Vec2 to = chain[0].at - here;
    if (length(to) < kTooNear * params.offset_m) {
      const bool abeam = std::abs(sense::dot(towards(here, chain[0].at), heading)) < kAbeam &&
                         sign * sense::cross(heading, to) > 0.0;
      if (abeam) {
        pass(chain[0], here, heading);
        chain.erase(chain.begin());
      } else {
        too_near_m_ = length(to);
      }
    }
  }
  // From within the offset the way begins abeam of it by its own line, wherever the vehicle stands:
  // whoever has only begun there has passed nothing.
  const bool stands_within = chain.size() == 1 && began_here_ &&
                             length(chain[0].at - behind_.back()) <= params.offset_m &&
                             length(here - behind_.back()) < kMoved_m;
  if (!chain.empty() && !too_near_m_ && !stands_within) {
    const Vec2 out = chain.size() > 1 ? towards(chain[0].at, chain[1].at)
                                      : past(behind_.back(), chain[0].at, sign, params.offset_m);
    // Abeam, and about where it should be passed: one that is far aside is still to be driven to.
    const Vec2 off = here - chain[0].at;
    if (sense::dot(off, out) > 0.0 && length(off) < 2.0 * params.offset_m) {
      pass(chain[0], chain[0].at - (sign * params.offset_m) * Vec2{-out.y, out.x}, out);
      chain.erase(chain.begin());
    }
  }
  first_.reset();
  if (!chain.empty()) {
    first_ = chain[0].id;
    eyes_ = chain[0].eyes;
  }
  std::vector<Vec2> places;
  for (const Landmark& l : chain) places.push_back(l.at);
  return landmark_way(places, behind_, pose, side, speed_mps, params);
}

}  // namespace roverd::nav::marks
