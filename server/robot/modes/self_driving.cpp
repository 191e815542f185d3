#include "robot/modes/self_driving.hpp"

namespace roverd::robot {
namespace {

using base::ActivityState;
using base::Mode;

constexpr std::string_view kCalibration = "calibration";

bool under_way(ActivityState s) noexcept {
  return s == ActivityState::Driving || s == ActivityState::Turning ||
         s == ActivityState::Waiting || s == ActivityState::Held;
}

}  // namespace

SelfDriving::SelfDriving(const ParameterSet& set)
    : guided_(set.path, set.behave, set.modes),
      dock_(set.path, set.behave, set.modes),
      tag_dock_(set.path, set.behave, set.marks.tag_dock),
      rtl_(set.path, set.behave),
      follow_(set.path, set.modes),
      calibrate_(set.path),
      stay_(set.path, set.behave),
      orbit_(set.path, set.behave) {}

void SelfDriving::begin(std::string_view kind) {
  calibrate_.end("the robot was told of something else to do: " + std::string(kind));
  const std::uint64_t id = activity_.id + 1;
  held_.go_on();
  activity_ = {};
  activity_.id = id;
  activity_.kind = kind;
  activity_.state = ActivityState::Driving;
}

void SelfDriving::wait_for_goal() {
  begin("goto");
  activity_.state = ActivityState::Waiting;
  activity_.reason = "no goal yet";
}

void SelfDriving::go(const nav::GuidedGoal& goal, std::string_view kind,
                     const nav::Vehicle& vehicle) {
  guided_.go(goal, vehicle);
  begin(kind);
}

void SelfDriving::go_home(const std::vector<base::EnuPoint>& way, bool retrace,
                          const nav::Vehicle& vehicle, base::LatLon to, double length_m) {
  rtl_.begin(way, vehicle, retrace);
  begin(retrace ? "retrace" : "return");
  activity_.goal = to;
  activity_.distance_m = length_m;
}

void SelfDriving::follow() {
  begin("follow");
}

void SelfDriving::dock(const nav::DockGoal& goal, const nav::Vehicle& vehicle) {
  dock_.begin(goal, vehicle);
  begin("dock");
}

void SelfDriving::dock_at(const nav::tags::TagDock::Order& order, base::Time now) {
  tag_dock_.begin(order, now);
  begin("dock");
  activity_.tag = order.tag;
}

void SelfDriving::begin_calibration(base::CalibrationKind kind, const nav::Vehicle& vehicle,
                                    const nav::CalibrationBefore& before,
                                    const nav::PathParams& set) {
  guided_.reset();
  begin(kCalibration);
  calibrate_.begin(kind, vehicle, before, set);
}

void SelfDriving::stay(const nav::StayGoal& goal, const nav::Vehicle& vehicle, base::LatLon at) {
  stay_.begin(goal, vehicle);
  begin("loiter");
  activity_.goal = at;
  activity_.radius_m = goal.within_m;
}

void SelfDriving::circle(const nav::OrbitGoal& goal, const nav::Vehicle& vehicle,
                         base::LatLon centre) {
  orbit_.begin(goal, vehicle);
  begin("circle");
  activity_.goal = centre;
  activity_.radius_m = goal.radius_m;
  activity_.turns = goal.turns;
  activity_.clockwise = goal.clockwise;
}

void SelfDriving::interrupt() noexcept {
  if (calibrate_.running()) {
    calibrate_.end("somebody else drove, or the base took no commands");
  }
  lay_anew();
}

void SelfDriving::lay_anew() noexcept {
  stay_.interrupt();
  orbit_.interrupt();
  guided_.interrupt();
  dock_.interrupt();
  tag_dock_.interrupt();
  rtl_.interrupt();
}

bool SelfDriving::hold(Mode mode) {
  // A figure that was broken off measures nothing.
  if (calibrate_.running()) {
    calibrate_.end("the radio took over");
    return false;
  }
  const bool no_goal = mode == Mode::Guided && activity_.state == ActivityState::Waiting;
  if (held_.waits() || no_goal || !under_way(activity_.state)) return false;
  held_.take(activity_.kind);
  activity_.state = ActivityState::Held;
  activity_.reason = held_.why();
  return true;
}

void SelfDriving::leave(Mode to, const std::string& why, bool stands_first) {
  if (under_way(activity_.state)) {
    activity_.state = ActivityState::Failed;
    activity_.reason = "ended by mode " + std::string(base::to_string(to)) + ": " + why;
  }
  calibrate_.end("ended by mode " + std::string(base::to_string(to)) + ": " + why);
  guided_.reset();
  dock_.reset();
  tag_dock_.reset();
  rtl_.reset();
  follow_.reset();
  stay_.reset();
  orbit_.reset();
  held_.go_on();
  changeover_.skip();
  if (stands_first) changeover_.begin();
}

SelfDriving::Step SelfDriving::step(const Facts& f) {
  if (held_.waits()) return {{}, "held", false, {}};
  if (changeover_.ends(f.vehicle.speed_mps, f.vehicle.yaw_rate_radps, f.dt_s)) lay_anew();
  if (changeover_.waits()) return {{}, "stopping", false, {}};
  const nav::TrackOutput out = step_mode(f);
  Step step{out.command, nav::to_string(out.reason), false, {}};
  const bool over =
      activity_.state == ActivityState::Reached || activity_.state == ActivityState::Failed;
  if (over) return step;
  step.ending = ending(f.mode);
  if (step.ending) {
    activity_.state = step.ending->state;
    activity_.reason =
        activity_.state == ActivityState::Reached ? std::string() : step.ending->detail;
    activity_.distance_m.reset();
    activity_.turn_rad.reset();
    return step;
  }
  tell(f);
  step.drives =
      activity_.state == ActivityState::Driving || activity_.state == ActivityState::Turning;
  return step;
}

nav::TrackOutput SelfDriving::step_mode(const Facts& f) {
  switch (f.mode) {
    case Mode::Guided:
      if (activity_.kind == kCalibration) return calibrate_.step(f.vehicle, f.limit_mps, f.dt_s);
      return guided_.step(f.vehicle, f.limit_mps, f.dt_s);
    case Mode::Rtl:
    case Mode::SmartRtl:
      return rtl_.step(f.vehicle, f.limit_mps, f.dt_s);
    case Mode::Follow:
      return follow_.step(f.vehicle, f.limit_mps, f.now, f.dt_s);
    case Mode::Dock:
      if (activity_.tag) return tag_dock_.step(f.tags, f.vehicle, f.limit_mps, f.dt_s);
      return dock_.step(f.vehicle, f.limit_mps, f.dt_s);
    case Mode::Loiter:
      return stay_.step(f.vehicle, f.limit_mps, f.dt_s);
    case Mode::Circle:
      return orbit_.step(f.vehicle, f.limit_mps, f.dt_s);
    case Mode::Auto:
    case Mode::Manual:
    case Mode::Hold:
    case Mode::Steering:
    case Mode::Acro:
    case Mode::Simple:
      break;
  }
  return {};
}

std::optional<SelfDriving::Ending> SelfDriving::calibrated() const {
  switch (calibrate_.state()) {
    case nav::Calibrate::State::Done:
      return Ending{ActivityState::Reached, "calibration_done",
                    "the calibration of the " + std::string(to_string(calibrate_.kind())) +
                        " is measured: keep or discard it"};
    case nav::Calibrate::State::Failed:
    case nav::Calibrate::State::Ended:
    case nav::Calibrate::State::Idle:
      return Ending{ActivityState::Failed, "calibration_failed",
                    "the calibration measured nothing: " + calibrate_.reason()};
    case nav::Calibrate::State::Running:
      break;
  }
  return std::nullopt;
}

std::optional<SelfDriving::Ending> SelfDriving::docked() const {
  if (activity_.tag) {
    const std::string at = " at tag " + std::to_string(*activity_.tag);
    if (tag_dock_.state() == nav::tags::TagDock::State::Docked) {
      return Ending{ActivityState::Reached, "docked", "docked" + at};
    }
    if (tag_dock_.state() != nav::tags::TagDock::State::Failed) return std::nullopt;
    return Ending{ActivityState::Failed, "dock_failed",
                  "not docked" + at + ": " + tag_dock_.reason()};
  }
  if (dock_.state() == nav::Dock::State::Docked) {
    return Ending{ActivityState::Reached, "docked", "docked"};
  }
  if (dock_.state() != nav::Dock::State::Failed) return std::nullopt;
  return Ending{ActivityState::Failed, "dock_failed", "not docked: " + dock_.reason()};
}

/// What the machine of this mode came to.
std::optional<SelfDriving::Ending> SelfDriving::ending(Mode mode) const {
  const auto reached = [](const char* kind, std::string detail) {
    return Ending{ActivityState::Reached, kind, std::move(detail)};
  };
  const auto failed = [](const char* kind, std::string detail) {
    return Ending{ActivityState::Failed, kind, std::move(detail)};
  };
  switch (mode) {
    case Mode::Guided:
      if (activity_.kind == kCalibration) return calibrated();
      if (guided_.state() == nav::Guided::State::Reached) {
        return reached("goal_reached",
                       "the goal of this " + std::string(activity_.kind) + " is reached");
      }
      if (guided_.state() == nav::Guided::State::Failed) {
        return failed("goal_failed", guided_.reason());
      }
      break;
    case Mode::Rtl:
    case Mode::SmartRtl:
      if (rtl_.state() == nav::Rtl::State::Home) {
        return reached("home_reached", "home is reached");
      }
      if (rtl_.state() == nav::Rtl::State::Failed) {
        return failed("return_failed", "the way home: " + rtl_.reason());
      }
      break;
    case Mode::Follow:
      if (follow_.state() == nav::Follow::State::Lost) {
        return failed("target_lost", follow_.reason());
      }
      break;
    case Mode::Dock:
      return docked();
    case Mode::Loiter:
      if (stay_.state() == nav::Stay::State::Failed) {
        return failed("goal_failed", "back to the place: " + stay_.reason());
      }
      break;
    case Mode::Circle:
      if (orbit_.state() == nav::Orbit::State::Done) {
        return reached("goal_reached", "the circle's turns are driven");
      }
      if (orbit_.state() == nav::Orbit::State::Failed) {
        return failed("goal_failed", "the circle: " + orbit_.reason());
      }
      break;
    case Mode::Auto:
    case Mode::Manual:
    case Mode::Hold:
    case Mode::Steering:
    case Mode::Acro:
    case Mode::Simple:
      break;
  }
  return std::nullopt;
}

void SelfDriving::tell_guided(const Facts& f) {
  base::Activity& a = activity_;
  const nav::Guided::State s = guided_.state();
  if (s == nav::Guided::State::Waiting) a.state = ActivityState::Waiting;
  a.reason = s == nav::Guided::State::Waiting && guided_.reason().empty() ? "no goal yet"
                                                                          : guided_.reason();
  if (guided_.place()) a.goal = f.frame.to_global(*guided_.place());
  if (s != nav::Guided::State::Waiting) a.goal_yaw_rad = guided_.goal().yaw_rad;
  a.distance_m = guided_.distance_left_m(f.vehicle.at);
  a.turn_rad = guided_.trip().turn_left_rad();
}

void SelfDriving::tell_place(const Facts& f) {
  base::Activity& a = activity_;
  if (f.mode == Mode::Circle) {
    a.goal = f.frame.to_global(orbit_.goal().centre);
    a.distance_m = orbit_.distance_left_m();
    return;
  }
  a.goal = f.frame.to_global(stay_.goal().at);
  a.distance_m = stay_.distance_m(f.vehicle.at);
  if (stay_.state() != nav::Stay::State::Staying) return;
  a.state = ActivityState::Waiting;
  a.reason = "stays here";
}

void SelfDriving::tell_tag() {
  using State = nav::tags::TagDock::State;
  const State s = tag_dock_.state();
  activity_.distance_m = tag_dock_.distance_left_m();
  activity_.reason = s == State::Search   ? "looks for the tag"
                     : s == State::ToGate ? "drives before the tag"
                     : s == State::Look   ? "looks at the tag"
                     : s == State::Line   ? "drives to the tag"
                     : s == State::Back   ? "backs up for another try"
                                          : "";
}

/// Where the mode stands, in the words of the snapshot.
void SelfDriving::tell(const Facts& f) {
  base::Activity& a = activity_;
  a.state = ActivityState::Driving;
  a.reason.clear();
  a.turn_rad.reset();
  a.distance_m.reset();
  if (activity_.kind == kCalibration) {
    a.reason = calibrate_.reason();
  } else if (f.mode == Mode::Guided) {
    tell_guided(f);
  } else if (f.mode == Mode::Rtl || f.mode == Mode::SmartRtl) {
    a.distance_m = rtl_.trip().distance_left_m();
  } else if (f.mode == Mode::Loiter || f.mode == Mode::Circle) {
    tell_place(f);
  } else if (f.mode == Mode::Dock && a.tag) {
    tell_tag();
  } else if (f.mode == Mode::Dock) {
    a.goal = f.frame.to_global(dock_.goal().at);
    a.goal_yaw_rad = dock_.goal().yaw_rad;
    a.distance_m = dock_.distance_left_m();
    a.reason = dock_.reason();
  } else if (f.mode == Mode::Follow && follow_.target()) {
    a.target = f.frame.to_global(follow_.target()->at);
    a.target_age_s = base::seconds(f.now - follow_.target()->stamp);
    a.distance_m = follow_.distance_m(f.vehicle.at);
    const bool waits = follow_.state() == nav::Follow::State::Braking;
    if (waits) a.state = ActivityState::Waiting;
    a.reason = waits ? "the target is silent" : "";
  }
  if (a.turn_rad) a.state = ActivityState::Turning;
}

}  // namespace roverd::robot
