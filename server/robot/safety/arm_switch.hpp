#pragma once
// May anything move at all? Two switches: armed, and the latched emergency stop, which is the
// stronger one.
//
//   Disarmed ──arm──▶ Armed ──disarm, a fault, latch──▶ Disarmed
//   Released ──latch: anyone, the base, the bumper──▶ Latched ──release──▶ Released (disarmed)
//
// Whether arming or releasing is allowed is asked before: by the checks, and by those who press the
// stop. Pure; control thread.

#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/snapshot.hpp"
#include "robot/world.hpp"

namespace roverd::robot {

class ArmSwitch {
 public:
  bool armed() const noexcept { return armed_; }
  bool latched() const noexcept { return latched_; }

  /// Armed although the position was not known: to be driven by hand.
  bool by_hand() const noexcept { return armed_ && by_hand_; }

  /// @return false: latched, or armed already.
  bool arm(bool by_hand = false) noexcept {
    if (latched_ || armed_) return false;
    armed_ = true;
    by_hand_ = by_hand;
    return true;
  }
  /// @return whether it was armed.
  bool disarm() noexcept {
    const bool was = armed_;
    armed_ = false;
    return was;
  }

  struct Latch {
    bool newly = false;
    bool disarmed = false;  ///< it was armed
  };
  Latch latch() noexcept {
    if (latched_) return {};
    latched_ = true;
    return {true, disarm()};
  }
  /// @return whether it was latched.
  bool release() noexcept {
    const bool was = latched_;
    latched_ = false;
    return was;
  }

 private:
  bool armed_ = false;
  bool by_hand_ = false;
  bool latched_ = false;
};

/// Every failing check by name; empty: arming is allowed.
/// @param by_hand somebody drives who sees where it is: the position is not asked for
std::optional<base::Error> arming_refusal(const std::vector<base::Check>& checks,
                                          bool by_hand = false);
/// Who still presses the stop; empty: nobody.
std::string release_refusal(const World& world);

}  // namespace roverd::robot
