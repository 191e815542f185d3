#include "nav/tags/tag_book.hpp"

#include <algorithm>
#include <chrono>

namespace roverd::nav::tags {
namespace {

/// 1σ of when a picture was taken: how late a camera is is told roughly, and a network or a busy
/// computer adds to it.
constexpr base::Duration kMoment = std::chrono::milliseconds(100);

}  // namespace

std::size_t TagBook::take(const TagsSeen& seen) {
  ++images_;
  const auto pose = history_.at(seen.stamp);
  if (!pose) {
    ++refused_;
    return 0;
  }
  const sense::Pose2 earlier = history_.at(seen.stamp - kMoment).value_or(*pose);
  looked_at_ = std::max(looked_at_, seen.stamp);
  std::size_t taken = 0;
  for (const TagPlace& tag : seen.tags) {
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
