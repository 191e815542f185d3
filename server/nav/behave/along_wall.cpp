#include "nav/behave/along_wall.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roverd::nav {
namespace {

constexpr double kAhead = 0.7;           // cos 45 degrees: so far aside it is not ahead any more
constexpr double kInTheWay = 0.5;        // of the offset, on the other side
constexpr double kGivenUp_m = 1.0;       // of way, before another one is begun with
constexpr double kBesidePlace_m = 10.0;  // a place that lies farther off is not passed
constexpr double kOffset_m = 0.1;        // more than the offset, for the first bend

}  // namespace

AlongWall::AlongWall(base::Setting<PathParams> wall_path, base::Setting<PathParams> landmark_path,
                     const MarkSettings& params)
    : params_(params),
      wall_(std::move(wall_path), params),
      landmarks_(std::move(landmark_path), params) {}

void AlongWall::begin(const Order& order) noexcept {
  reset();
  order_ = order;
  wall_.begin(order.wall);
}

void AlongWall::reset() noexcept {
  wall_.reset();
  landmarks_.reset();
  until_.reset();
  passes_ = false;
  seen_since_.reset();
  not_before_m_ = 0.0;
}

void AlongWall::interrupt() noexcept {
  wall_.interrupt();
  if (passes_) landmarks_.interrupt();
  seen_since_.reset();
}

/// On the wall's side, or in the way.
bool AlongWall::one_ahead(const MarkSight& sight) const noexcept {
  if (sight.view == nullptr) return false;
  const marks::Pose2 to_body = sense::inverse(sight.body);
  const double side = order_.wall.side == marks::Side::Left ? 1.0 : -1.0;
  const double offset_m = landmarks_.offset_m();
  return std::ranges::any_of(
      sight.view->landmarks_by(landmarks_by()), [&](const marks::Landmark& l) {
        if (!l.believed) return false;
        if (base::seconds(sight.now - l.seen_at) > params_.sight->old_s) return false;
        const marks::Vec2 at = marks::placed(to_body, l.at);
        const double far_m = std::hypot(at.x, at.y);
        return far_m > offset_m + kOffset_m && far_m < params_.landmarks->max_range_m &&
               at.x > kAhead * far_m && side * at.y > -kInTheWay * offset_m;
      });
}

/// What is seen decides; not for a glance.
void AlongWall::choose(const MarkSight& sight) {
  if (!one_ahead(sight)) return seen_since_.reset();
  if (!seen_since_) seen_since_ = sight.now;
  const bool sure = base::seconds(sight.now - *seen_since_) >= kSure_s;
  if (!sure || wall_.driven_m() < not_before_m_) return;
  LandmarkDrive::Order pass;
  pass.side = order_.wall.side;
  pass.speed_mps = order_.wall.speed_mps;
  pass.by = order_.wall.by;
  landmarks_.begin(std::move(pass));
  passes_ = true;
  wall_.carried(sight.body);
}

/// As far as the item goes, or past the place that ends it.
bool AlongWall::far_enough(const marks::Pose2& body) const noexcept {
  if (order_.wall.length_m && wall_.driven_m() >= *order_.wall.length_m) return true;
  if (!until_) return false;
  const marks::Vec2 at = marks::placed(sense::inverse(body), {until_->east_m, until_->north_m});
  return at.x <= 0.0 && std::hypot(at.x, at.y) <= kBesidePlace_m;
}

TrackOutput AlongWall::step(const MarkSight& sight, const Vehicle& vehicle, double limit_mps,
                            double dt_s) {
  const bool under_way = wall_.state() == State::Seeking || wall_.state() == State::Driving;
  if (order_.landmarks_first && under_way && !passes_) choose(sight);
  if (!passes_) return wall_.step(sight, vehicle, limit_mps, dt_s);
  const TrackOutput out = landmarks_.step(sight, vehicle, limit_mps, dt_s);
  wall_.carried(sight.body);
  using Passing = LandmarkDrive::State;
  const bool passing =
      landmarks_.state() == Passing::Seeking || landmarks_.state() == Passing::Driving;
  if (far_enough(sight.body)) {
    passes_ = false;
    landmarks_.reset();
    wall_.finish();
    return {};
  }
  if (passing) return out;
  if (landmarks_.state() == Passing::Failed) not_before_m_ = wall_.driven_m() + kGivenUp_m;
  passes_ = false;
  seen_since_.reset();
  landmarks_.reset();
  wall_.interrupt();
  return wall_.step(sight, vehicle, limit_mps, dt_s);
}

}  // namespace roverd::nav
