#include "nav/behave/tag_dock.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/angle.hpp"
#include "nav/behave/mark_sight.hpp"

namespace roverd::nav::tags {
namespace {

constexpr int kMostTries = 3;
constexpr double kBehind_m = 1.0;
constexpr double kLineTimeout_s = 60.0;
constexpr double kOnLine_m = 0.06;
constexpr double kOnLine_rad = 0.09;
constexpr int kMostGates = 6;
constexpr int kMostTurns = 3;
constexpr double kMostLooks = 20.0;
constexpr int kLeastSights = 3;         ///< taken standing
constexpr double kLatePicture_s = 0.3;  ///< what came so soon after it stood may show it driving
constexpr double kSurely = 3.0;  ///< sigmas: it looks until it is sure, and twice would often lie
constexpr double kArrive_m = 0.01;
constexpr double kPicture_m = 0.002;  ///< by which all pictures of a tag err alike
constexpr double kGateTurn_deg = 0.8;
constexpr double kLate_m = 0.06;               ///< it stops beyond the place, at most
constexpr double kBeyond_m = 0.6 * kArrive_m;  ///< it stands up to kArrive_m before a line's end

EnuPoint at(const sense::Pose2& p) noexcept {
  return {p.x_m, p.y_m};
}

std::string millimetres(double m) {
  return std::to_string(std::lround(m * 1000.0)) + " mm";
}

std::string tenths(double deg) {
  return std::to_string(std::lround(deg * 10.0)) + " tenths of a degree";
}

}  // namespace

/// Where it stands, against where it should, and how well that is known (1σ).
struct TagDock::Stand {
  double off_m = 0.0;
  double off_deg = 0.0;
  bool known = false;  ///< the tag's direction is
  double sigma_m = 0.0;
  double sigma_deg = 0.0;
  bool within = false;  ///< the tolerance, surely
  bool beside = false;  ///< it, surely
  bool sure = false;    ///< as well as the tolerance asks
};

/// Short settling, and a stop within millimetres: at the speed of docking both are calm.
PathParams TagDock::careful(PathParams p) {
  p.track.settle_min_m = std::min(p.track.settle_min_m, 0.25);
  p.track.arrive_m = std::min(p.track.arrive_m, kArrive_m);
  p.speed.min_mps = std::min(p.speed.min_mps, 0.05);
  p.pivot.done_deg = std::min(p.pivot.done_deg, 0.3);
  return p;
}

/// Up to the gate no turn need end as closely as on the line: a robot that obeys late might not.
PathParams TagDock::on_the_way(const PathParams& said) {
  PathParams p = careful(said);
  p.pivot.done_deg = std::min(said.pivot.done_deg, kGateTurn_deg);
  return p;
}

TagDock::TagDock(base::Setting<PathParams> path, base::Setting<BehaveParams> behave,
                 base::Setting<TagDockParams> params)
    : said_(std::move(path)),
      path_(base::Setting<PathParams>(careful(*said_))),
      way_(base::Setting<PathParams>(on_the_way(*said_))),
      params_(std::move(params)),
      trip_(way_, std::move(behave)),
      tracker_(path_) {}

void TagDock::begin(const Order& order, base::Time now) {
  path_.adopt(std::make_shared<const PathParams>(careful(*said_)));
  way_.adopt(std::make_shared<const PathParams>(on_the_way(*said_)));
  trip_.reset();
  tracker_.reset();
  line_.reset();
  goal_.reset();
  left_.reset();
  order_ = order;
  seen_at_ = now;
  taken_ = {};
  news_ = false;
  tries_ = 0;
  late_m_ = 0.0;
  gates_ = 0;
  looked_s_ = 0.0;
  again_ = false;
  reason_.clear();
  state_ = State::Search;
}

void TagDock::interrupt() noexcept {
  if (state_ == State::Idle || state_ == State::Docked || state_ == State::Failed) return;
  trip_.reset();
  tracker_.reset();
  looked_s_ = 0.0;
  again_ = true;
  state_ = goal_ ? State::Look : State::Search;
}

/// What is known of the tag now; a sight from before the begin is none.
void TagDock::look(const TagSight& sight) {
  const KnownTag* known = sight.book != nullptr ? sight.book->find(order_.tag) : nullptr;
  track_ = known != nullptr ? &known->track : nullptr;
  const bool fresh =
      track_ != nullptr && track_->pose() && track_->seen_at() > std::max(taken_, seen_at_);
  if (!fresh) return;
  taken_ = seen_at_ = track_->seen_at();
  news_ = true;
  goal_ =
      *track_->pose() * sense::Pose2{-order_.stand_off_m.value_or(params_->stand_off_m), 0.0, 0.0};
}

std::string TagDock::why_unseen(const TagSight& sight) const {
  const auto twice = sight.book != nullptr ? sight.book->twice_at(order_.tag) : std::nullopt;
  if (twice && *twice > seen_at_) {
    return "two tags of number " + std::to_string(order_.tag) +
           " are seen at once: nobody knows which one is meant";
  }
  return goal_ ? "the tag is not seen any more" : "the tag is not seen";
}

void TagDock::fail(std::string why) {
  reason_ = std::move(why);
  state_ = State::Failed;
}

/// Along the line, to the pose; negative: beyond it.
double TagDock::left_m(const Vehicle& v) const noexcept {
  const EnuPoint to = at(*goal_) - v.at;
  return to.east_m * std::cos(goal_->yaw_rad) + to.north_m * std::sin(goal_->yaw_rad);
}

void TagDock::to_gate(const Vehicle& v) {
  Trip::Order order;
  Vertex gate;
  gate.at = at(*goal_ * sense::Pose2{-params_->gate_m, 0.0, 0.0});
  gate.speed_mps = params_->way_mps;
  order.way.push_back(gate);
  order.face_yaw_rad = goal_->yaw_rad;
  order.within_m = 0.3;
  state_ = State::ToGate;
  trip_.begin(std::move(order), v, false);
}

void TagDock::back(const Vehicle& v) {
  Trip::Order order;
  Vertex gate;
  gate.at = at(*goal_ * sense::Pose2{-params_->gate_m, 0.0, 0.0});
  gate.speed_mps = params_->dock_mps;
  gate.reverse = true;
  order.way.push_back(gate);
  order.face_yaw_rad = goal_->yaw_rad;
  state_ = State::Back;
  trip_.begin(std::move(order), v, false);
}

/// @param first from a stand; else the way that is driven is replaced by the newer one: over the
/// last straight_m by one of the same direction, which ends where the tag is seen now.
void TagDock::lay_line(const Vehicle& v, bool first) {
  const double here_m = left_m(v);
  if (first || here_m > params_->straight_m) {
    line_end_ = *goal_;
  } else {
    line_end_ = line_end_ * sense::Pose2{(sense::inverse(line_end_) * *goal_).x_m, 0.0, 0.0};
  }
  Vertex begin;
  begin.at = at(line_end_ * sense::Pose2{-(std::max(here_m, 0.0) + kBehind_m), 0.0, 0.0});
  begin.speed_mps = params_->dock_mps;
  Vertex end = begin;
  end.at = at(line_end_ * sense::Pose2{kBeyond_m - late_m_, 0.0, 0.0});
  const std::vector<Vertex> both{begin, end};
  auto path = std::make_shared<const Path>(build_path(both, *path_));
  if (path->legs.empty()) return;
  if (first) {
    tracker_.reset();
    tracker_.begin(*path, 0, kBehind_m);
    on_line_s_ = 0.0;
    turns_ = 0;
  } else {
    tracker_.move_to(*path, 0, kBehind_m);
  }
  line_ = std::move(path);
  state_ = State::Line;
}

/// By the tag where it is still seen, else by the odometry since: both stand in the goal, and what
/// each is worth in the uncertainty.
TagDock::Stand TagDock::stand(const TagSight& sight, const Vehicle& v) const noexcept {
  Stand s;
  s.off_m = base::distance_m(v.at, at(*goal_));
  s.off_deg = std::abs(base::deg_from_rad(base::angle_diff_rad(v.yaw_rad, goal_->yaw_rad)));
  s.known = track_ != nullptr && track_->direction_known();
  if (!s.known) return s;
  const auto [sigma_m, sigma_rad] = track_->sigma_before(sight.body);
  s.sigma_m = std::hypot(sigma_m, kPicture_m);
  s.sigma_deg = base::deg_from_rad(sigma_rad);
  const TagDockParams& p = *params_;
  s.within = s.off_m + kSurely * s.sigma_m <= p.within_m &&
             s.off_deg + kSurely * s.sigma_deg <= p.within_deg;
  s.beside = s.off_m - kSurely * s.sigma_m > p.within_m ||
             s.off_deg - kSurely * s.sigma_deg > p.within_deg;
  s.sure = kSurely * s.sigma_m < p.within_m && kSurely * s.sigma_deg < p.within_deg;
  return s;
}

void TagDock::judge(const Stand& s, const Vehicle& v) {
  if (s.within) {
    state_ = State::Docked;
    return;
  }
  // How late it stops is its own, and the same the next time.
  late_m_ = std::clamp(late_m_ - left_m(v), -kLate_m, kLate_m);
  if (++tries_ < kMostTries) return back(v);
  if (!s.known) return fail("which way the tag faces stays in doubt");
  if (!s.sure) {
    return fail("the tag is not seen well enough: the place before it is known to " +
                millimetres(s.sigma_m) + ", the direction to " + tenths(s.sigma_deg) +
                " (1 sigma)");
  }
  fail("stands " + millimetres(s.off_m) + " and " + tenths(s.off_deg) + " off after " +
       std::to_string(kMostTries) + " tries");
}

/// From here on pictures count as taken standing, once they can be.
void TagDock::stands_anew(base::Time now) noexcept {
  stood_at_ = now;
  looked_s_ = 0.0;
  sights_ = 0;
}

TrackOutput TagDock::step_line(const TagSight& sight, const Vehicle& v, double limit_mps,
                               double dt_s) {
  on_line_s_ += dt_s;
  if (on_line_s_ > kLineTimeout_s) {
    fail("the line took too long");
    return {};
  }
  if (news_ && tracker_.phase() == TrackPhase::Track) lay_line(v, false);
  const TrackOutput out = tracker_.step(v, std::min(params_->dock_mps, limit_mps), dt_s);
  if (tracker_.phase() != TrackPhase::Done) {
    stands_anew(sight.now);
    return out;
  }
  // It stands where the tag is seen best: a last look, and a small turn where that helps.
  looked_s_ += dt_s;
  if (news_ && base::seconds(taken_ - stood_at_) > kLatePicture_s) ++sights_;
  if (looked_s_ < params_->look_s || sights_ < kLeastSights) return out;
  const double off_deg = base::deg_from_rad(base::angle_diff_rad(v.yaw_rad, goal_->yaw_rad));
  if (std::abs(off_deg) > 0.4 * params_->within_deg && turns_ < kMostTurns) {
    ++turns_;
    stands_anew(sight.now);
    tracker_.begin_turn(goal_->yaw_rad);
    return out;
  }
  // Each image makes it surer.
  const Stand s = stand(sight, v);
  const bool may_decide = s.known && !s.within && !s.beside;
  if (may_decide && looked_s_ < kMostLooks * params_->look_s) return out;
  judge(s, v);
  return out;
}

/// To the gate, or back to it.
TrackOutput TagDock::step_trip(const TagSight& sight, const Vehicle& v, double limit_mps,
                               double dt_s) {
  const TrackOutput out = trip_.step(v, limit_mps, dt_s);
  if (trip_.state() == Trip::State::Failed) fail(trip_.reason());
  if (trip_.state() == Trip::State::There) {
    state_ = State::Look;
    looked_s_ = 0.0;
    seen_at_ = std::max(seen_at_, sight.now);  // from here on it must be seen
  }
  return out;
}

/// Long enough: one image may mistake the tag's direction, and what begins with it is not steady.
bool TagDock::looked(double dt_s) noexcept {
  looked_s_ += dt_s;
  const bool steady = track_ != nullptr && track_->steady();
  return looked_s_ >= (steady ? 1.0 : kMostLooks) * params_->look_s;
}

/// From here the tag is seen better than from afar: its line may lie elsewhere by now.
void TagDock::step_look(const Vehicle& v, double dt_s) {
  if (!looked(dt_s)) return;
  const sense::Pose2 off =
      sense::inverse(*goal_) * sense::Pose2{v.at.east_m, v.at.north_m, v.yaw_rad};
  const bool on = std::abs(off.y_m) < kOnLine_m && std::abs(off.yaw_rad) < kOnLine_rad;
  // Closer than that it must not turn: back to the gate first.
  const bool close = off.x_m > -0.5 * params_->gate_m;
  if (on || gates_ >= kMostGates) return lay_line(v, true);
  ++gates_;
  if (close) return back(v);
  to_gate(v);
}

TrackOutput TagDock::step(const TagSight& sight, const Vehicle& vehicle, double limit_mps,
                          double dt_s) {
  if (state_ == State::Idle || state_ == State::Docked || state_ == State::Failed) return {};
  const Vehicle v = by_odometry(sight.body, vehicle);
  if (std::exchange(again_, false)) seen_at_ = std::max(seen_at_, sight.now);
  look(sight);
  const bool near = state_ == State::Line && goal_ && left_m(v) <= params_->straight_m &&
                    tracker_.phase() != TrackPhase::Done;  // standing it must be seen
  const bool turning = state_ == State::ToGate || state_ == State::Back;  // it may look away
  if (!near && !turning && base::seconds(sight.now - seen_at_) > params_->lost_s) {
    fail(why_unseen(sight));
    return {};
  }
  TrackOutput out;
  if (state_ == State::Search) {
    if (goal_ && looked(dt_s)) to_gate(v);
  } else if (turning) {
    out = step_trip(sight, v, limit_mps, dt_s);
  } else if (state_ == State::Look) {
    step_look(v, dt_s);
  } else {
    out = step_line(sight, v, limit_mps, dt_s);
  }
  news_ = false;
  track_ = nullptr;
  left_ = goal_ ? std::optional(std::max(0.0, base::distance_m(v.at, at(*goal_)))) : std::nullopt;
  return out;
}

std::optional<double> TagDock::distance_left_m() const noexcept {
  return left_;
}

std::string_view to_string(TagDock::State s) noexcept {
  switch (s) {
    case TagDock::State::Idle:
      return "idle";
    case TagDock::State::Search:
      return "search";
    case TagDock::State::ToGate:
      return "to_gate";
    case TagDock::State::Look:
      return "look";
    case TagDock::State::Line:
      return "line";
    case TagDock::State::Back:
      return "back";
    case TagDock::State::Docked:
      return "docked";
    case TagDock::State::Failed:
      return "failed";
  }
  return "";
}

}  // namespace roverd::nav::tags
