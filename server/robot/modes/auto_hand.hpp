#pragma once
// A hand on the speed of what drives by itself: a dead-man with a share of the speed. While nobody
// uses it nothing is slower. Once it is used it only ever slows, and what ends it ends in a stop.
//
//   Free ──held──▶ Held ──let go──▶ LetGo ──held again──▶ Held
//    ▲              └─silent, gone─▶ Lost ──let go by any──▶ LetGo
//    └── a person starts or goes on, out of a mode that does not drive by itself
//
// One source holds it; another one is refused until the first has let go, and must have been seen
// to let go itself. Control thread.

#include <algorithm>
#include <cstdint>
#include <string>

#include "base/time.hpp"

namespace roverd::robot {

/// One message of a hand.
struct HandOnSpeed {
  double share = 0.0;  ///< of the speed, [0, 1]
  bool held = false;
  std::uint64_t source = 0;
  bool gone = false;  ///< the source does not speak any more; not held
};

class AutoHand {
 public:
  enum class Phase { Free, Held, LetGo, Lost };
  /// Drawn less than this it stands.
  static constexpr double kNothing = 0.02;

  /// @return false: not obeyed, see why_not().
  bool say(const HandOnSpeed& h, base::Time now) noexcept {
    if (!h.held) {
      let_go(h);
      return true;
    }
    const bool may = phase_ == Phase::Free || (phase_ != Phase::Lost && source_ == h.source);
    if (!may) return false;
    phase_ = Phase::Held;
    source_ = h.source;
    share_ = std::clamp(h.share, 0.0, 1.0);
    last_ = now;
    return true;
  }

  /// A person began to drive by itself what stood: what is not held is not used any more.
  void begin() noexcept {
    if (phase_ != Phase::Held) phase_ = Phase::Free;
  }

  /// Once a tick. @return true: the hand was lost just now, and what drives by itself stops
  bool step(base::Time now, double timeout_s) noexcept {
    if (phase_ == Phase::Held && base::seconds(now - last_) > timeout_s) lose("is silent");
    const bool newly = phase_ == Phase::Lost && !told_;
    told_ = phase_ == Phase::Lost;
    return newly;
  }

  Phase phase() const noexcept { return phase_; }
  bool held() const noexcept { return phase_ == Phase::Held; }
  bool used() const noexcept { return phase_ != Phase::Free; }
  /// Of the speed, 0..1; 1 while nobody uses it.
  double share() const noexcept { return !used() ? 1.0 : phase_ == Phase::Held ? share_ : 0.0; }
  bool stands() const noexcept { return share() < kNothing; }

  /// What it does to the drive, for the operator; empty: nothing.
  std::string why() const {
    switch (phase_) {
      case Phase::Free:
        return "";
      case Phase::Held:
        if (stands()) return "the hand on the speed asks for none";
        return share_ < 1.0 ? "the hand on the speed asks for less" : "";
      case Phase::LetGo:
        return "the hand on the speed was let go: hold it again, or hold the robot (HOLD) and go "
               "on";
      case Phase::Lost:
        return std::string("the hand on the speed ") + cause_ +
               ": let go and hold it again, or hold the robot (HOLD) and go on";
    }
    return "";
  }
  std::string why_not() const {
    if (phase_ == Phase::Held) return "another client has its hand on the speed";
    return "let go of the speed first: " + why();
  }

 private:
  void let_go(const HandOnSpeed& h) noexcept {
    if (phase_ == Phase::Free) return;
    const bool other = phase_ == Phase::Held && source_ != h.source;
    if (other) return;
    if (h.gone) {
      if (source_ == h.source) lose("has left");
      return;
    }
    phase_ = Phase::LetGo;
    source_ = h.source;
  }
  void lose(const char* cause) noexcept {
    phase_ = Phase::Lost;
    cause_ = cause;
  }

  Phase phase_ = Phase::Free;
  std::uint64_t source_ = 0;
  double share_ = 0.0;
  base::Time last_{};
  const char* cause_ = "";
  bool told_ = false;
};

}  // namespace roverd::robot
