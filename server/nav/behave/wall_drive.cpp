#include "nav/behave/wall_drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "nav/behave/text.hpp"

namespace roverd::nav {
namespace {

constexpr double kSureOfEnd_s = 0.6;  // standing there, it looks on for so long
constexpr double kDone_m = 0.05;
constexpr double kPasses_m = 10.0;   // a place that lies farther aside is not passed
constexpr double kStops_mps = 0.05;  // above the slowest speed: braked

double between_m(EnuPoint a, EnuPoint b) noexcept {
  return std::hypot(b.east_m - a.east_m, b.north_m - a.north_m);
}

/// The same way, as far as end_m along it. @return it was longer.
bool cut(marks::Way& way, double end_m) {
  double gone_m = 0.0;
  for (std::size_t i = 1; i < way.vertices.size(); ++i) {
    const EnuPoint from = way.vertices[i - 1].at;
    const EnuPoint to = way.vertices[i].at;
    const double piece_m = between_m(from, to);
    if (gone_m + piece_m < end_m) {
      gone_m += piece_m;
      continue;
    }
    const double part = std::clamp((end_m - gone_m) / std::max(1e-9, piece_m), 0.0, 1.0);
    way.vertices[i].at = {from.east_m + part * (to.east_m - from.east_m),
                          from.north_m + part * (to.north_m - from.north_m)};
    way.vertices.resize(i + 1);
    std::erase_if(way.corners, [&](std::size_t k) { return k >= i; });
    return true;
  }
  return false;
}

/// How far along a way it passes a place. Empty: not within kPasses_m, or not before its end.
std::optional<double> beside(const marks::Way& way, EnuPoint place) noexcept {
  double gone_m = 0.0;
  double least_m = kPasses_m;
  std::optional<double> out;
  for (std::size_t i = 1; i < way.vertices.size(); ++i) {
    const EnuPoint from = way.vertices[i - 1].at;
    const EnuPoint to = way.vertices[i].at;
    const double piece_m = between_m(from, to);
    const double along_m = ((place.east_m - from.east_m) * (to.east_m - from.east_m) +
                            (place.north_m - from.north_m) * (to.north_m - from.north_m)) /
                           std::max(1e-9, piece_m);
    const bool beyond = along_m > piece_m && i + 1 == way.vertices.size();
    const double part = std::clamp(along_m / std::max(1e-9, piece_m), 0.0, 1.0);
    const double off_m = between_m(place, {from.east_m + part * (to.east_m - from.east_m),
                                           from.north_m + part * (to.north_m - from.north_m)});
    if (off_m <= least_m) {
      least_m = off_m;
      out = beyond ? std::nullopt : std::optional(gone_m + part * piece_m);
    }
    gone_m += piece_m;
  }
  return out;
}

}  // namespace

WallDrive::WallDrive(base::Setting<PathParams> path, MarkSettings params)
    : path_params_(path), params_(std::move(params)), drive_(std::move(path)) {}

void WallDrive::begin(const Order& order) noexcept {
  reset();
  order_ = order;
  driven_m_ = order.driven_m;
  state_ = State::Seeking;
}

void WallDrive::reset() noexcept {
  drive_.reset();
  state_ = State::Idle;
  reason_.clear();
  until_.reset();
  last_.reset();
  laid_.reset();
  scanned_at_ = imaged_at_ = {};
  driven_m_ = unseen_s_ = stood_s_ = 0.0;
  to_length_ = false;
}

void WallDrive::interrupt() noexcept {
  if (state_ == State::Driving || state_ == State::Failed) state_ = State::Seeking;
  drive_.reset();
  last_.reset();
  laid_.reset();
  unseen_s_ = stood_s_ = 0.0;
}

void WallDrive::fail(std::string why) {
  drive_.reset();
  state_ = State::Failed;
  reason_ = std::move(why);
}

std::string WallDrive::wall_text() const {
  return order_.side == marks::Side::Left ? "the wall on the left" : "the wall on the right";
}

std::string WallDrive::ended_text() const {
  switch (drive_.end()) {
    case marks::WayEnd::TooNarrow:
      return "there is no room along " + wall_text();
    case marks::WayEnd::NoEcho:
      return wall_text() + " gives no echo any more, and its end was not seen";
    default:
      return wall_text() + " is not seen any further";
  }
}

TrackPhase WallDrive::phase() const noexcept {
  switch (drive_.state()) {
    case marks::SightDrive::State::Idle:
      return TrackPhase::Idle;
    case marks::SightDrive::State::Driving:
      return TrackPhase::Track;
    case marks::SightDrive::State::Ended:
      return TrackPhase::Done;
  }
  return TrackPhase::Idle;
}

/// Forward along the body's own direction.
void WallDrive::count(const marks::Pose2& body, bool counts) noexcept {
  if (last_ && counts) {
    driven_m_ += (body.x_m - last_->x_m) * std::cos(body.yaw_rad) +
                 (body.y_m - last_->y_m) * std::sin(body.yaw_rad);
  }
  last_ = body;
}

double WallDrive::distance_m() const noexcept {
  return order_.distance_m.value_or(params_.walls->distance_m);
}

void WallDrive::carried(const marks::Pose2& body) noexcept {
  count(body, true);
}

void WallDrive::finish() noexcept {
  drive_.reset();
  state_ = State::Done;
}

marks::By WallDrive::by() const noexcept {
  return order_.by.value_or(marks::by_from(params_.walls->source).value_or(marks::By::Auto));
}

ToldBy WallDrive::told_by(base::Time now) const noexcept {
  if (state_ != State::Driving || !laid_) return {};
  const base::Time since = now - base::from_seconds(params_.sight->old_s);
  return {scanned_at_ >= since, imaged_at_ >= since};
}

/// Lays the way along what is known. @return false: nobody looks, or there is no wall.
bool WallDrive::look(const MarkSight& sight) {
  if (!sight.fresh(*params_.sight, by())) {
    laid_.reset();
    return false;
  }
  if (laid_ == sight.view->stamp) return unseen_s_ == 0.0;
  laid_ = sight.view->stamp;
  const double speed_mps =
      std::min(order_.speed_mps.value_or(params_.sight->speed_mps), path_params_->speed.max_mps);
  auto way = marks::wall_way(sight.view->walls_by(by()), sight.body, order_.side, distance_m(),
                             speed_mps, sight.now, *params_.walls);
  if (!way) return false;
  scanned_at_ = way->scanned_at;
  imaged_at_ = way->imaged_at;
  bool to_length = false;
  if (order_.length_m) {
    to_length = cut(*way, way->here_m + std::max(0.0, *order_.length_m - driven_m_));
  }
  if (until_) {
    if (const auto at_m = beside(*way, *until_)) {
      to_length = cut(*way, std::max(way->here_m, *at_m)) || to_length;
    }
  }
  const bool drives = drive_.take(*way);
  if (drives) stood_s_ = 0.0;
  if (drives || drive_.path() == nullptr) to_length_ = to_length;  // null: it ends where it stands
  state_ = State::Driving;
  return true;
}

/// Straight on from here.
void WallDrive::seek(const marks::Pose2& body) {
  if (drive_.state() != marks::SightDrive::State::Idle) return;
  // step() cuts its speed.
  const auto way = straight_on(body, params_.sight->entry_m, path_params_->speed.max_mps);
  const std::string side = order_.side == marks::Side::Left ? "left" : "right";
  if (!drive_.take(way)) fail("no wall is seen on the " + side);
}

/// Where it stands, what does that mean?
void WallDrive::judge(double dt_s) {
  using marks::WayEnd;
  const bool ended = drive_.state() == marks::SightDrive::State::Ended;
  if (state_ == State::Seeking) {
    const std::string side = order_.side == marks::Side::Left ? "left" : "right";
    if (ended) {
      fail("no wall is seen on the " + side + " within " + tenths_text(params_.sight->entry_m));
    }
    return;
  }
  if (order_.length_m && driven_m_ > *order_.length_m - kDone_m && ended) state_ = State::Done;
  if (ended && to_length_) state_ = State::Done;
  if (state_ == State::Done) return;
  stood_s_ = ended ? stood_s_ + dt_s : 0.0;
  // At its very end there is no way to lay any more; but somebody must look.
  const bool ends = drive_.end() == WayEnd::WallEnds && laid_.has_value();
  if (ends && stood_s_ > kSureOfEnd_s) {
    state_ = State::Done;
  } else if (unseen_s_ > params_.sight->old_s + params_.sight->wait_s) {
    fail(wall_text() + " is not seen any more");
  } else if (!ends && stood_s_ > params_.sight->wait_s) {
    fail(ended_text());
  }
}

TrackOutput WallDrive::step(const MarkSight& sight, const Vehicle& vehicle, double limit_mps,
                            double dt_s) {
  if (state_ != State::Seeking && state_ != State::Driving) return {};
  if (distance_m() <= touches_wall_m(path_params_->vehicle)) {
    fail("nav.wall.distance_m is " + tenths_text(distance_m()) + ": this vehicle would touch it");
    return {};
  }
  const Vehicle v = by_odometry(sight, vehicle);
  count(sight.body, state_ == State::Driving);
  unseen_s_ = look(sight) ? 0.0 : unseen_s_ + dt_s;
  if (state_ == State::Seeking) seek(sight.body);
  if (state_ == State::Failed) return {};
  const bool lost = state_ == State::Driving && unseen_s_ > params_.sight->old_s;
  const double most_mps = state_ == State::Seeking ? params_.sight->creep_mps : limit_mps;
  TrackOutput out = drive_.step(v, lost ? 0.0 : std::min(limit_mps, most_mps), dt_s);
  if (lost && std::abs(v.speed_mps) < kStops_mps + path_params_->speed.min_mps) out.command = {};
  judge(dt_s);
  return state_ == State::Seeking || state_ == State::Driving ? out : TrackOutput{};
}

}  // namespace roverd::nav
