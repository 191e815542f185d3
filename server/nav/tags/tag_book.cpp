#include "nav/tags/tag_book.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <Eigen/Geometry>

namespace roverd::nav::tags {
namespace {

/// 1σ of when a picture was taken: how late a camera is is told roughly, and a network or a busy
/// computer adds to it.
constexpr base::Duration kMoment = std::chrono::milliseconds(100);

}  // namespace

TagPlace level(const TagPlace& seen, const sense::Lie3& lie) noexcept {
  const auto vertical = sense::up_in_body(lie);
  const Eigen::Vector3d up{vertical[0], vertical[1], vertical[2]};
  const Eigen::Vector3d ahead = (Eigen::Vector3d::UnitX() - up.x() * up).normalized();
  const Eigen::Vector3d left = up.cross(ahead);
  const Eigen::Vector3d place{seen.pose.x_m, seen.pose.y_m, seen.up_m};
  const double flat = std::sqrt(std::max(0.0, 1.0 - seen.into_up * seen.into_up));
  const Eigen::Vector3d into{flat * std::cos(seen.pose.yaw_rad), flat * std::sin(seen.pose.yaw_rad),
                             seen.into_up};
  TagPlace out = seen;
  out.pose = {ahead.dot(place), left.dot(place), std::atan2(left.dot(into), ahead.dot(into))};
  out.up_m = up.dot(place);
  out.into_up = up.dot(into);
  return out;
}

std::size_t TagBook::take(const TagsSeen& seen) {
  ++images_;
  const auto pose = history_.at(seen.stamp);
  if (!pose) {
    ++refused_;
    return 0;
  }
  const sense::Pose2 earlier = history_.at(seen.stamp - kMoment).value_or(*pose);
  const sense::Lie3 lie = history_.lie_at(seen.stamp);
  looked_at_ = std::max(looked_at_, seen.stamp);
  std::size_t taken = 0;
  for (const TagPlace& told : seen.tags) {
    const TagPlace tag = level(told, lie);
    if (std::ranges::count(seen.tags, tag.id, &TagPlace::id) > 1) {
      ++twice_;
      twice_id_ = tag.id;
      twice_at_ = seen.stamp;
      continue;
    }
    auto known = std::ranges::find(known_, tag.id, &KnownTag::id);
    if (known == known_.end()) {
      KnownTag fresh;
      fresh.id = tag.id;
      if (!fresh.track.take(tag, *pose, seen.stamp, earlier)) continue;
      if (known_.size() >= kMost) {
        known_.erase(std::ranges::min_element(known_, {},
                                              [](const KnownTag& k) { return k.track.seen_at(); }));
      }
      known = known_.insert(known_.end(), std::move(fresh));
    } else if (!known->track.take(tag, *pose, seen.stamp, earlier)) {
      continue;
    }
    ++known->sights;
    if (known->camera != seen.camera) known->camera = seen.camera;
    ++taken;
  }
  return taken;
}

const KnownTag* TagBook::find(int id) const noexcept {
  const auto known = std::ranges::find(known_, id, &KnownTag::id);
  return known == known_.end() ? nullptr : &*known;
}

}  // namespace roverd::nav::tags
