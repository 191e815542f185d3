#include "nav/behave/landmark_drive.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "nav/behave/text.hpp"

namespace roverd::nav {
namespace {

constexpr double kLooksOn_s = 0.6;  // standing behind the last one
constexpr double kWorthDriving_m = 0.05;
constexpr double kBraked_mps = 0.05;  // above the slowest speed

double length_m(const marks::Way& way) noexcept {
  double out = 0.0;
  for (std::size_t i = 1; i < way.vertices.size(); ++i) {
    out += base::distance_m(way.vertices[i - 1].at, way.vertices[i].at);
  }
  return out;
}

}  // namespace

LandmarkDrive::LandmarkDrive(base::Setting<PathParams> path, MarkSettings params)
    : path_params_(path), params_(std::move(params)), drive_(std::move(path)) {}

void LandmarkDrive::begin(Order order) noexcept {
  reset();
  order_ = std::move(order);
  state_ = State::Seeking;
}

void LandmarkDrive::reset() noexcept {
  drive_.reset();
  course_ = {};
  state_ = State::Idle;
  reason_.clear();
  order_ = {};
  laid_.reset();
  told_by_ = {};
  begun_ = again_ = ahead_ = false;
  unseen_s_ = stood_s_ = 0.0;
}

void LandmarkDrive::interrupt() noexcept {
  if (state_ == State::Driving || state_ == State::Failed) state_ = State::Seeking;
  drive_.reset();
  laid_.reset();
  again_ = begun_;
  ahead_ = false;
  unseen_s_ = stood_s_ = 0.0;
}

void LandmarkDrive::fail(std::string why) {
  drive_.reset();
  state_ = State::Failed;
  reason_ = std::move(why);
}

std::string LandmarkDrive::what() const {
  return order_.name.empty() ? "landmark" : "landmark called \"" + order_.name + "\"";
}

TrackPhase LandmarkDrive::phase() const noexcept {
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

double LandmarkDrive::offset_m() const noexcept {
  return order_.offset_m.value_or(params_.landmarks->offset_m);
}

marks::By LandmarkDrive::by() const noexcept {
  return order_.by.value_or(marks::by_from(params_.landmarks->source).value_or(marks::By::Auto));
}

ToldBy LandmarkDrive::told_by() const noexcept {
  return state_ == State::Driving && laid_ ? told_by_ : ToldBy{};
}

/// Lays the way past what is known. @return false: nobody looks, or there is nothing to drive to.
bool LandmarkDrive::look(const MarkSight& sight) {
  const auto told = [&] {
    if (sight.view == nullptr) return false;
    // Behind so many nobody has to say that no more follow.
    if (enough()) return sight.fresh(*params_.sight);
    const marks::Eyes eyes = course_.eyes(sight.view->landmarks_by(by()));
    return eyes != 0 ? sight.fresh(*params_.sight, eyes) : sight.fresh(*params_.sight, by());
  };
  const auto nobody_looks = [&] {
    laid_.reset();
    return false;
  };
  if (!told()) return nobody_looks();
  if (laid_ == sight.view->stamp) return unseen_s_ == 0.0;
  laid_ = sight.view->stamp;
  marks::LandmarkParams params = *params_.landmarks;
  params.offset_m = offset_m();
  const double speed_mps =
      std::min(order_.speed_mps.value_or(params_.sight->speed_mps), path_params_->speed.max_mps);
  const auto lay = [&](std::span<const marks::Landmark> known) {
    return course_.lay(known, sight.body, order_.side, order_.name, speed_mps, params);
  };
  const auto known = sight.view->landmarks_by(by());
  auto way = lay(enough() ? std::span<const marks::Landmark>() : known);
  if (enough()) way = lay({});
  if (const auto near_m = course_.too_near_m()) {
    fail("stands too near to a landmark (" + tenths_text(*near_m) + ")");
    return false;
  }
  ahead_ = course_.ahead();
  const marks::Eyes eyes = course_.eyes(known);
  told_by_ = {(eyes & sight.view->eyes[0]) != 0, (eyes & sight.view->eyes[1]) != 0};
  if (!told()) return nobody_looks();
  if (!ahead_ && course_.passed() == 0) return false;
  // Where one that was driven to is gone, the way may end behind the robot already.
  const bool leads_on = length_m(way) - way.here_m > kWorthDriving_m;
  if (!ahead_ && !leads_on) return drive_.state() == marks::SightDrive::State::Ended;
  if (drive_.take(way)) stood_s_ = 0.0;
  state_ = State::Driving;
  return true;
}

/// Straight on from here.
void LandmarkDrive::seek(const marks::Pose2& body) {
  if (drive_.state() != marks::SightDrive::State::Idle) return;
  // step() cuts its speed.
  const auto way = straight_on(body, params_.sight->entry_m, path_params_->speed.max_mps);
  if (!drive_.take(way)) end_or_fail("no " + what() + " is seen");
}

/// Nothing is left to drive to: all were passed, as far as anybody said how many.
void LandmarkDrive::end_or_fail(std::string why) {
  if (enough() || (!order_.count && passed() > 0)) {
    drive_.reset();
    state_ = State::Done;
    return;
  }
  if (passed() > 0) {
    why = "only " + std::to_string(passed()) + " of " + std::to_string(order_.count.value_or(0)) +
          " landmarks were seen";
  }
  fail(std::move(why));
}

/// Where it stands, what does that mean?
void LandmarkDrive::judge(double dt_s) {
  const bool ended = drive_.state() == marks::SightDrive::State::Ended;
  if (state_ == State::Seeking) {
    if (!laid_) {
      stood_s_ += dt_s;
      if (stood_s_ <= params_.sight->old_s + params_.sight->wait_s) return;
      const std::string why = "nothing looks for landmarks";
      return enough() ? end_or_fail(why) : fail(why);
    }
    stood_s_ = 0.0;
    if (!ended) return;
    return end_or_fail("no " + what() + " is seen within " + tenths_text(params_.sight->entry_m));
  }
  stood_s_ = ended ? stood_s_ + dt_s : 0.0;
  const bool looked = laid_.has_value();  // somebody must look to say that there are no more
  const double wait_s = enough() ? kLooksOn_s : params_.sight->wait_s;
  if (ended && ahead_ && looked && stood_s_ > std::max(wait_s, kLooksOn_s)) {
    fail("its way ends before the " + what() + " is passed");
  } else if (ended && !ahead_ && looked && stood_s_ > (order_.count ? wait_s : kLooksOn_s)) {
    end_or_fail("no " + what() + " is seen any more");
  } else if (unseen_s_ > params_.sight->old_s + params_.sight->wait_s) {
    const std::string why = "no " + what() + " is seen any more";
    looked || enough() ? end_or_fail(why) : fail(why);
  }
}

TrackOutput LandmarkDrive::step(const MarkSight& sight, const Vehicle& vehicle, double limit_mps,
                                double dt_s) {
  if (state_ != State::Seeking && state_ != State::Driving) return {};
  if (enough() && course_.passed() == 0) {  // they were passed before
    drive_.reset();
    state_ = State::Done;
    return {};
  }
  if (offset_m() <= touches_landmark_m(path_params_->vehicle)) {
    fail("nav.landmarks.offset_m is " + tenths_text(offset_m()) +
         ": this vehicle would drive over them");
    return {};
  }
  const Vehicle v = by_odometry(sight, vehicle);
  if (!begun_) course_.begin(sight.body);
  if (again_) course_.go_on(sight.body);
  begun_ = true;
  again_ = false;
  unseen_s_ = look(sight) ? 0.0 : unseen_s_ + dt_s;
  if (state_ == State::Seeking) seek(sight.body);
  if (state_ == State::Failed || state_ == State::Done) return {};
  const bool lost = state_ == State::Driving && unseen_s_ > params_.sight->old_s;
  const bool blind = state_ == State::Seeking && !laid_;
  const bool brakes = lost || blind;
  const double most_mps = brakes                     ? 0.0
                          : state_ == State::Seeking ? params_.sight->creep_mps
                                                     : limit_mps;
  TrackOutput out = drive_.step(v, std::min(limit_mps, most_mps), dt_s);
  if (brakes && std::abs(v.speed_mps) < kBraked_mps + path_params_->speed.min_mps) out.command = {};
  judge(dt_s);
  return state_ == State::Seeking || state_ == State::Driving ? out : TrackOutput{};
}

}  // namespace roverd::nav
