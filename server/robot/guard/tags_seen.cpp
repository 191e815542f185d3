// Tags in the robot: what its cameras read of them, and who is told.

#include <utility>

#include "robot/impl.hpp"

namespace roverd::robot {

void Robot::Impl::read_the_tags(const nav::sense::Odometry& now) {
  if (!reads_tags) return;
  (void)tag_book.moved(now);
  tags_batch.clear();
  if (!tags.try_take(tags_batch)) return;
  for (const auto& image : tags_batch) {
    (void)tag_book.take(*image);
    known_places.see(*image, estimator, clock.now());
  }
  tags_batch.clear();
}

void Robot::Impl::take_known_places() {
  known_batch.clear();
  if (!known_lists.try_take(known_batch) || known_batch.empty()) return;
  known_places.set(known_batch.back());
  known_batch.clear();
}

/// Once for each word of the sense thread.
void Robot::Impl::see_known_poles() {
  const auto& around = guard.around();
  if (known_places.empty() || !around || !around->beside) return;
  if (looked_beside == around->beside) return;
  looked_beside = around->beside;
  known_places.see(*looked_beside, estimator, clock.now());
}

nav::tags::TagSight Robot::Impl::tag_sight() const noexcept {
  return {reads_tags ? &tag_book : nullptr, clock.now(), guard.odometry().pose};
}

/// Whoever docks at one: DOCK, or an item of the mission. Null: nobody does.
const nav::tags::TagDock* Robot::Impl::docks_at_tag() const noexcept {
  if (machine.mode() == Mode::Dock) return self_driving.docks_at_tag();
  if (machine.mode() == Mode::Auto) return missions.executor.docks();
  return nullptr;
}

/// For people, from where the body is now. Null: no camera of this robot reads tags.
std::shared_ptr<const std::vector<base::TagState>> Robot::Impl::tag_states() const {
  if (!reads_tags) return nullptr;
  auto out = std::make_shared<std::vector<base::TagState>>();
  const nav::sense::Pose2 to_body = nav::sense::inverse(guard.odometry().pose);
  for (const nav::tags::KnownTag& known : tag_book.all()) {
    const auto place = known.track.pose();
    if (!place) continue;
    const nav::sense::Pose2 here = to_body * *place;
    const auto [sigma_m, sigma_rad] = known.track.sigma_from(guard.odometry().pose);
    base::TagState tag;
    tag.id = known.id;
    tag.ahead_m = here.x_m;
    tag.left_m = here.y_m;
    tag.sigma_m = sigma_m;
    if (known.track.direction_known()) {
      tag.yaw_rad = here.yaw_rad;
      tag.yaw_sigma_rad = sigma_rad;
    }
    tag.camera = known.camera;
    tag.sights = known.sights;
    tag.seen_at = known.track.seen_at();
    out->push_back(std::move(tag));
  }
  return out;
}

}  // namespace roverd::robot
