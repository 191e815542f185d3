#pragma once
// The modes by hand over the network: MANUAL, and ACRO, STEERING, SIMPLE with help. The dead-man's
// handle is that of modes/manual.hpp. Control thread.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nav/behave/sticks.hpp"
#include "robot/modes/manual.hpp"
#include "robot/parameter_set.hpp"

namespace roverd::robot {

class ByHand {
 public:
  explicit ByHand(const ParameterSet& set)
      : params_(set.manual), manual_(set.manual), sticks_(set.path, set.modes) {}

  /// @return false: not obeyed, see why().
  bool drive(const Handle& handle, base::Time now) noexcept { return manual_.drive(handle, now); }
  /// Something begins: whoever holds the handle must let go first. @param cause a static text
  void lock(const char* cause, base::Time now) noexcept { manual_.lock(cause, now); }
  Manual::Phase phase() const noexcept { return manual_.phase(); }
  double share_of_speed(base::Time now) const noexcept { return manual_.share_of_speed(now); }
  std::optional<double> delay_s(base::Time now) const noexcept { return manual_.delay_s(now); }
  bool overrides_guard() const noexcept { return manual_.overrides_guard(); }
  bool in_vain(base::Time now) const noexcept { return manual_.in_vain(now); }
  std::string why() const { return manual_.why(); }
  const std::vector<std::uint64_t>& released() const noexcept { return manual_.released(); }

  /// A mode with help begins.
  void begin(base::Mode mode, const nav::Vehicle& vehicle) noexcept {
    sticks_.begin(mode == base::Mode::Acro       ? nav::StickMode::Acro
                  : mode == base::Mode::Steering ? nav::StickMode::Steering
                                                 : nav::StickMode::Simple,
                  vehicle);
  }

  struct Step {
    base::BodyTwist twist;
    bool held = false;        ///< a person drives
    bool stale = false;       ///< he stopped speaking while he held it
    std::string_view reason;  ///< of the speed; empty: nothing of its own
  };
  /// Once a tick. MANUAL: the sticks as they are.
  Step plain(base::Time now, double dt_s) noexcept {
    const base::BodyTwist twist = manual_.step(now, dt_s);
    return {twist, held(), stale(), held() ? "manual" : stale() ? "teleop_stale" : ""};
  }
  /// The others. @param vehicle null: where it is, is not known: it stands
  Step helped(const nav::Vehicle* vehicle, double limit_mps, base::Time now, double dt_s) noexcept {
    if (vehicle == nullptr) manual_.lock("the position was not known", now);
    const base::BodyTwist stick = manual_.step(now, dt_s);
    Step step{{}, held(), stale(), stale() ? "teleop_stale" : ""};
    if (vehicle == nullptr) return step;
    const base::BodyTwist full{params_->max_mps, params_->max_yaw_rate_radps};
    const nav::TrackOutput out = sticks_.step(stick, full, *vehicle, limit_mps, dt_s);
    step.twist = out.command;
    if (step.held) step.reason = nav::to_string(out.reason);
    return step;
  }

 private:
  bool held() const noexcept { return manual_.phase() == Manual::Phase::Held; }
  bool stale() const noexcept { return manual_.stale(); }

  base::Setting<ManualParams> params_;
  Manual manual_;
  nav::Sticks sticks_;
};

}  // namespace roverd::robot
