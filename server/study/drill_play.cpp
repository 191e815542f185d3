// One failure: the robot drives up to the place, something breaks, and its true pose tells the
// rest.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/angle.hpp"
#include "robot/compile.hpp"
#include "robot/safety/start_check.hpp"
#include "study/drill.hpp"
#include "study/drill_failures.hpp"
#include "study/stage.hpp"

namespace roverd::study {
namespace {

using base::Result;
using Finish = std::optional<DrillEnd>;

constexpr std::uint64_t kDrillSeed = 1;
constexpr double kArms_s = 60.0;
constexpr double kArrives_s = 120.0;  ///< and twice the time that the way up to the place takes
constexpr double kBefore_m = 0.1;     ///< a stop on the way is driven to as exactly as that
constexpr double kMoves_mps = 0.01;
constexpr double kMoves_radps = 0.01;
constexpr double kRests_s = 2.0;       ///< standing so long, with nothing that drives it on
constexpr double kTrackEvery_m = 0.1;  ///< at first
constexpr std::size_t kTrackMost = 200;
constexpr int kWordEvery = 25;  ///< ticks from an operator's word to the next

bool moving(const sim::Truth& t) {
  return std::abs(t.twist.linear_mps) > kMoves_mps ||
         std::abs(t.twist.angular_radps) > kMoves_radps ||
         std::abs(t.left_track_mps) > kMoves_mps || std::abs(t.right_track_mps) > kMoves_mps;
}

DrillPose pose_of(const sim::Truth& t) {
  return {t.at, base::heading_from_yaw(t.yaw_rad)};
}

double to_segment_m(base::EnuPoint p, base::EnuPoint a, base::EnuPoint b) {
  const base::EnuPoint way = b - a;
  const base::EnuPoint off = p - a;
  const double square = way.east_m * way.east_m + way.north_m * way.north_m;
  const double along = off.east_m * way.east_m + off.north_m * way.north_m;
  const double part = square > 0.0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
  return base::distance_m(p, {a.east_m + part * way.east_m, a.north_m + part * way.north_m});
}

/// From the nearest place of the way that it may have come to.
double off_way_m(const DrillPlace& place, base::LatLon at, double driven_m) {
  constexpr double kAround_m = 20.0;
  const base::EnuPoint here = place.frame.to_local(at);
  double best_m = std::numeric_limits<double>::infinity();
  const auto& points = place.path.points;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (points[i + 1].s_m < place.at_m - kAround_m) continue;
    if (points[i].s_m > place.at_m + driven_m + kAround_m) break;
    best_m = std::min(best_m, to_segment_m(here, points[i].at, points[i + 1].at));
  }
  return best_m;
}

/// The body's distance to the fence, where it really is.
class Surveyor {
 public:
  Surveyor(const DrillOrder& order, const DrillPlace& place)
      : body_(order.settings.robot.vehicle), frame_(place.frame) {
    if (order.fence) limits_.emplace(*order.fence, frame_);
  }

  void look(const sim::Truth& t) {
    if (!limits_) return;
    const double middle_m = body_.steered() ? 0.5 * body_.wheelbase_m : 0.0;
    const base::EnuPoint at = frame_.to_local(t.at);
    const auto corner = [&](double forward, double left) {
      const double x = middle_m + 0.5 * forward * body_.length_m;
      const double y = 0.5 * left * body_.width_m;
      return base::EnuPoint{at.east_m + x * std::cos(t.yaw_rad) - y * std::sin(t.yaw_rad),
                            at.north_m + x * std::sin(t.yaw_rad) + y * std::cos(t.yaw_rad)};
    };
    const base::EnuPoint corners[] = {corner(1, 1), corner(1, -1), corner(-1, -1), corner(-1, 1)};
    for (std::size_t i = 0; i < 4; ++i) {
      nearest_m_ = std::min(nearest_m_, limits_->clearance_m(corners[i], corners[(i + 1) % 4]));
    }
  }
  std::optional<double> nearest_m() const {
    return limits_ && std::isfinite(nearest_m_) ? std::optional(nearest_m_) : std::nullopt;
  }

 private:
  const nav::VehicleParams& body_;
  const base::LocalFrame& frame_;
  std::optional<mission::CompiledFence> limits_;
  double nearest_m_ = std::numeric_limits<double>::infinity();
};

class Player {
 public:
  Player(const DrillOrder& order, const DrillPlace& place)
      : order_(order),
        place_(place),
        stage_(order.settings, order.plant, kDrillSeed, place.start),
        surveyor_(order, place) {}

  Result<DrillResult> run(const PlayedFailure& failure) {
    out_.failure = failure.id;
    if (auto off = set_off(); !off) return tl::unexpected(off.error());
    if (!drive_up()) return out_;
    begin(failure);
    watch(failure);
    return std::move(out_);
  }

 private:
  const base::Snapshot& state() {
    now_ = stage_.robot().snapshot();
    return *now_;
  }

  void tick() {
    if (ride_.operator_there && ticks_++ % kWordEvery == 0) {
      const base::Time now{base::from_seconds(stage_.now_s())};
      stage_.robot().measurements().put(base::OperatorLink{now, 1});
    }
    if (ride_.each_tick) ride_.each_tick(stage_);
    stage_.tick();
  }

  tl::unexpected<base::Error> cannot(const std::string& what, const base::Error& why) {
    return base::fail(base::Code::Conflict, what + ": " + why.detail);
  }

  Result<void> become_ready() {
    tick();
    while (!state().ready_to_arm && stage_.now_s() < kArms_s) tick();
    if (state().ready_to_arm) return {};
    std::string why;
    for (const base::Check& check : state().checks) {
      if (!check.ok && check.severity == base::Severity::Error) {
        why += (why.empty() ? "" : "; ") + check.detail;
      }
    }
    return cannot("the simulated robot refuses to be armed", {base::Code::Conflict, why});
  }

  /// Armed and on its mission, in its middle: as after a restart.
  Result<void> set_off() {
    if (auto ready = become_ready(); !ready) return ready;
    robot::Robot& robot = stage_.robot();
    const auto fence = robot.lay_fence(order_.fence);
    if (auto held = stage_.ask(robot::SetFence{fence}); !held) {
      return cannot("the fence is refused", held.error());
    }
    if (auto armed = stage_.ask(robot::Arm{}); !armed) {
      return cannot("the simulated robot refuses to be armed", armed.error());
    }
    auto compiled = robot.compile(order_.mission);
    if (!compiled) return cannot("the mission cannot be driven", compiled.error());
    for (const mission::Finding& finding : robot.objections(**compiled, {})) {
      if (finding.severity != mission::Severity::Error || robot::of_the_moment(finding)) continue;
      return cannot("the robot would refuse to start", {base::Code::Conflict, sentence(finding)});
    }
    if (auto gone = stage_.ask(robot::ResumeAt{*compiled, beginning(**compiled)}); !gone) {
      return cannot("the robot would refuse to start", gone.error());
    }
    if (!order_.home) return {};
    if (auto home = stage_.ask(robot::SetHome{order_.home}); !home) {
      return cannot("home is refused", home.error());
    }
    return {};
  }

  base::MissionPlace beginning(const robot::CompiledMission& mission) const {
    const nav::Course& course = mission.route.forth;
    base::MissionPlace p;
    p.s_m = place_.from_m;
    for (std::size_t i = 0; i < course.steps.size(); ++i) {
      const nav::RouteStep& step = course.steps[i];
      if (step.kind != nav::StepKind::Go) continue;
      p.step = static_cast<int>(i);
      if (course.path.vertex_m[step.node] > place_.from_m + kBefore_m) break;
    }
    return p;
  }

  /// @return false: it does not come to the place, and says why.
  bool drive_up() {
    const double way_s = place_.path.left_s(place_.from_m) - place_.path.left_s(place_.at_m);
    const double until_s = stage_.now_s() + kArrives_s + 2.0 * way_s;
    while (stage_.now_s() < until_s) {
      const base::MissionProgress& m = state().mission;
      if (m.place && m.place->s_m >= place_.at_m - kBefore_m) return true;
      if (m.state != base::ExecutionState::Running) {
        out_.reason = "before it came to the place it was " + std::string(to_string(m.state)) +
                      ": " + m.reason;
        return false;
      }
      tick();
    }
    out_.reason = "it did not come to the place in time";
    return false;
  }

  void begin(const PlayedFailure& failure) {
    for (const auto& condition : state().safety) known_.push_back(condition.id);
    const sim::Truth t = stage_.plant().truth();
    began_s_ = stage_.now_s();
    began_m_ = t.driven_m;
    out_.begins = pose_of(t);
    out_.speed_mps = t.twist.linear_mps;
    out_.track.push_back(t.at);
    surveyor_.look(t);
    if (failure.begin != nullptr) return failure.begin(ride_);
    sim::Faults faults;
    failure.breaks(faults);
    (void)stage_.plant().set_faults(faults);
  }

  void watch(const PlayedFailure& failure) {
    double moved_s = 0.0;
    double commanded_s = 0.0;
    Finish end;
    double at_s = 0.0;
    while (!end && at_s < order_.limit_s) {
      tick();
      at_s = stage_.now_s() - began_s_;
      const sim::Truth t = stage_.plant().truth();
      if (moving(t)) moved_s = at_s;
      if (stage_.alive() && state().command.twist != base::BodyTwist{}) commanded_s = at_s;
      note(t);
      if (at_s - moved_s >= kRests_s) end = rests();
    }
    const sim::Truth t = stage_.plant().truth();
    out_.last = pose_of(t);
    if (out_.track.back() != t.at) out_.track.push_back(t.at);
    out_.way_m = t.driven_m - began_m_;
    out_.off_way_m = off_way_m(place_, t.at, out_.way_m);
    out_.fence_m = surveyor_.nearest_m();
    out_.end = end.value_or(DrillEnd::GoesOn);
    if (end) out_.stands_s = moved_s;
    if (end && stage_.alive()) out_.zero_s = commanded_s;
    conclude(failure);
  }

  void note(const sim::Truth& t) {
    surveyor_.look(t);
    draw(t.at);
    if (!stage_.alive()) return;
    for (const auto& condition : state().safety) {
      if (std::find(known_.begin(), known_.end(), condition.id) != known_.end()) continue;
      const bool told = std::any_of(out_.said.begin(), out_.said.end(),
                                    [&](const auto& c) { return c.id == condition.id; });
      if (!told) out_.said.push_back(condition);
    }
  }

  /// A long way is drawn in longer steps.
  void draw(base::LatLon at) {
    auto& track = out_.track;
    if (base::distance_bearing(track.back(), at).distance_m < track_every_m_) return;
    track.push_back(at);
    if (track.size() < kTrackMost) return;
    for (std::size_t i = 1; 2 * i < track.size(); ++i) track[i] = track[2 * i];
    track.resize((track.size() + 1) / 2);
    track_every_m_ *= 2.0;
  }

  /// It stands: for good, as far as anybody can tell?
  Finish rests() {
    if (!stage_.alive()) return DrillEnd::Stands;
    const base::Snapshot& s = state();
    if (s.mission.state == base::ExecutionState::Finished) return DrillEnd::Finished;
    const bool returned = s.activity.kind == "return" || s.activity.kind == "retrace";
    if (returned && s.activity.state == base::ActivityState::Reached) return DrillEnd::Home;
    if (!s.armed || s.estop || s.control == base::Driver::Radio) return DrillEnd::Stands;
    const bool drives =
        (s.mode == base::Mode::Auto && s.mission.state == base::ExecutionState::Running) ||
        s.activity.state == base::ActivityState::Driving ||
        s.activity.state == base::ActivityState::Turning;
    return drives ? std::nullopt : Finish(DrillEnd::Stands);
  }

  void conclude(const PlayedFailure& failure) {
    if (!stage_.alive()) {
      out_.reason = "no command comes any more: the base stops by itself";
      return;
    }
    const base::Snapshot& s = state();
    out_.mode = base::to_string(s.mode);
    out_.armed = s.armed;
    out_.estop = s.estop;
    out_.reason = s.mission.reason;
    if (out_.end == DrillEnd::Stands || out_.end == DrillEnd::Home) return;
    out_.reason = why_on(failure, s);
    if (out_.end != DrillEnd::GoesOn) return;
    out_.reason += "; it does not stand after " + std::to_string(std::lround(order_.limit_s)) +
                   " s of simulated time";
  }

  std::string why_on(const PlayedFailure& failure, const base::Snapshot& s) const {
    if (s.mode == base::Mode::Rtl || s.mode == base::Mode::SmartRtl) return "it returns";
    if (failure.why_on != nullptr) {
      if (auto meant = failure.why_on(order_.settings.robot); !meant.empty()) return meant;
    }
    return out_.said.empty() ? "nothing was noticed" : "it says so, and drives on";
  }

  const DrillOrder& order_;
  const DrillPlace& place_;
  Stage stage_;
  Surveyor surveyor_;
  Ride ride_{stage_, order_.settings};
  DrillResult out_;
  std::shared_ptr<const base::Snapshot> now_;
  std::vector<std::string> known_;  ///< conditions that there were before
  double track_every_m_ = kTrackEvery_m;
  double began_s_ = 0.0;
  double began_m_ = 0.0;
  int ticks_ = 0;
};

}  // namespace

std::vector<std::string_view> failures_of(const DrillOrder& order) {
  if (!order.failures.empty()) return order.failures;
  std::vector<std::string_view> out;
  for (const PlayedFailure& failure : played_failures()) {
    if (failure.there_is(order.settings, order.plant)) out.push_back(failure.id);
  }
  return out;
}

base::Result<DrillResult> play(const DrillOrder& order, const DrillPlace& place,
                               std::string_view failure) {
  const auto& all = played_failures();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const PlayedFailure& f) { return f.id == failure; });
  if (found == all.end() || !found->there_is(order.settings, order.plant)) {
    DrillResult none;
    none.failure = failure;
    none.reason = "the simulated " + order.settings.vehicle.name + " has no such thing";
    return none;
  }
  return Player(order, place).run(*found);
}

}  // namespace roverd::study
