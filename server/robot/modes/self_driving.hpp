#pragma once
// The modes that drive by themselves and are no mission: GUIDED, RTL, SMART_RTL, FOLLOW, DOCK,
// LOITER, CIRCLE. One of them is in hand; what it does is the activity.
//
//   begin ──▶ Driving ──there──▶ Reached            of GUIDED another goal begins anew
//     │        │  ▲  └─cannot──▶ Failed
//     │        │  └──resume──┐
//     │        └─the radio──▶ Held                  modes/held_by_radio.hpp
//     └── rolling: stands first                     modes/changeover.hpp
//   any ──another mode──▶ Failed, with the reason
//
// Frame: everything local is of the robot's frame. Control thread.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/snapshot.hpp"
#include "base/time.hpp"
#include "nav/behave/dock.hpp"
#include "nav/behave/follow.hpp"
#include "nav/behave/guided.hpp"
#include "nav/behave/orbit.hpp"
#include "nav/behave/rtl.hpp"
#include "nav/behave/stay.hpp"
#include "nav/behave/tag_dock.hpp"
#include "nav/calibrate/calibrate.hpp"
#include "robot/modes/changeover.hpp"
#include "robot/modes/held_by_radio.hpp"
#include "robot/parameter_set.hpp"

namespace roverd::robot {

class SelfDriving {
 public:
  struct Facts {
    base::Mode mode;
    nav::Vehicle vehicle;
    const base::LocalFrame& frame;
    double limit_mps = 0.0;
    base::Time now;
    double dt_s = 0.0;
    nav::tags::TagSight tags{};
  };

  /// What it came to, once.
  struct Ending {
    base::ActivityState state = base::ActivityState::Reached;  ///< or Failed
    const char* kind = "";                                     ///< of the event
    std::string detail;
  };

  struct Step {
    base::BodyTwist twist;
    std::string_view reason;  ///< of the speed
    bool drives = false;      ///< else it stands, or waits
    std::optional<Ending> ending;
  };

  explicit SelfDriving(const ParameterSet& set);

  // Beginning. The mode is entered before (modes/machine.hpp).
  void wait_for_goal();  ///< GUIDED, without one
  void go(const nav::GuidedGoal& goal, std::string_view kind, const nav::Vehicle& vehicle);
  /// @param retrace SMART_RTL. @param to the way's end. @param length_m of the way
  void go_home(const std::vector<base::EnuPoint>& way, bool retrace, const nav::Vehicle& vehicle,
               base::LatLon to, double length_m);
  void follow();
  void dock(const nav::DockGoal& goal, const nav::Vehicle& vehicle);
  void dock_at(const nav::tags::TagDock::Order& order, base::Time now);
  /// Null: it does not.
  const nav::tags::TagDock* docks_at_tag() const noexcept {
    return activity_.tag ? &tag_dock_ : nullptr;
  }
  /// GUIDED, by a figure in the place of a goal. @param set as the parameters say
  void begin_calibration(base::CalibrationKind kind, const nav::Vehicle& vehicle,
                         const nav::CalibrationBefore& before, const nav::PathParams& set);
  /// It drives, and measures.
  bool calibrates() const noexcept { return calibrate_.running(); }
  nav::Calibrate& calibration() noexcept { return calibrate_; }
  const nav::Calibrate& calibration() const noexcept { return calibrate_; }
  /// On the last straight to it.
  std::optional<nav::DockGoal> docks_at() const {
    return dock_.state() == nav::Dock::State::Straight ? std::optional(dock_.goal()) : std::nullopt;
  }
  /// @param at the same place
  void stay(const nav::StayGoal& goal, const nav::Vehicle& vehicle, base::LatLon at);
  /// @param centre likewise
  void circle(const nav::OrbitGoal& goal, const nav::Vehicle& vehicle, base::LatLon centre);

  // Why this cannot be; empty: it can.
  std::string refusal(const nav::GuidedGoal& goal) const { return guided_.refusal(goal); }
  std::string refusal(const nav::OrbitGoal& goal) const { return orbit_.refusal(goal); }
  std::string follow_refusal(base::EnuPoint here, base::Time now) const {
    return follow_.refusal(here, now);
  }
  /// A target for FOLLOW, in any mode. Empty: taken; else why it is not believed.
  std::string take(const nav::FollowTarget& target, const nav::FollowOffset& offset) {
    return follow_.take(target, offset);
  }

  /// Once a tick while one of these modes drives, armed and heard.
  Step step(const Facts& facts);

  /// Somebody else moves the robot at this tick.
  void interrupt() noexcept;
  /// The radio took over. @return whether something was under way that now waits for a word
  bool hold(base::Mode mode);
  /// That word. Nothing if nothing waits.
  void go_on() noexcept { held_.go_on(); }
  const HeldByRadio& held() const noexcept { return held_; }

  /// Another mode begins. @param stands_first it drives by itself
  void leave(base::Mode to, const std::string& why, bool stands_first);

  const base::Activity& activity() const noexcept { return activity_; }

 private:
  void begin(std::string_view kind);
  /// The way in hand, from where it stands now.
  void lay_anew() noexcept;
  nav::TrackOutput step_mode(const Facts& f);
  std::optional<Ending> ending(base::Mode mode) const;
  std::optional<Ending> calibrated() const;
  void tell(const Facts& f);
  void tell_guided(const Facts& f);
  void tell_place(const Facts& f);
  void tell_tag();
  std::optional<Ending> docked() const;

  nav::Guided guided_;
  nav::Dock dock_;
  nav::tags::TagDock tag_dock_;  ///< in its place where the activity names a tag
  nav::Rtl rtl_;
  nav::Follow follow_;
  nav::Calibrate calibrate_;
  nav::Stay stay_;
  nav::Orbit orbit_;
  Changeover changeover_;
  HeldByRadio held_;
  base::Activity activity_;
};

}  // namespace roverd::robot
