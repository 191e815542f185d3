#pragma once
// What the radio interrupted waits for a word. A person who takes the sticks and leads the robot
// elsewhere has not said that it may drive off once he lets go of them: only a mission, which a
// person laid out and started as a whole, goes on by itself.
//
//   Free ──the radio takes over a goal, a move, a return, a pursuit, a docking──▶ Held
//    ▲                                                                             │
//    └────────────── resume, another goal, another mode (also the same again) ─────┘
//
// Control thread.

#include <string>
#include <string_view>

namespace roverd::robot {

class HeldByRadio {
 public:
  /// @param kind of the activity: "goto"; a static text
  void take(std::string_view kind) noexcept {
    kind_ = kind;
    waits_ = true;
  }
  void go_on() noexcept { waits_ = false; }

  bool waits() const noexcept { return waits_; }
  /// Why nothing moves, and what helps.
  std::string why() const {
    return "the radio took over: the " + std::string(kind_) + " waits until it is resumed";
  }

 private:
  std::string_view kind_;
  bool waits_ = false;
};

}  // namespace roverd::robot
