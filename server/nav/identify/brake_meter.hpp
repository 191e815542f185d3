#pragma once
// How hard the vehicle brakes and speeds up, seen on its own wheels.
//
//   v │ ───╲ told                  the slope over 0.3 s, when the order to brake is older than the
//     │     ╲  ╲ measured          delay and not yet carried out:
//     │      ╲    ╲                  less steep than told ─▶ that is all it can: Limit
//     │       ╲      ╲               as steep as told     ─▶ it can do this at least: Shown
//     └────────┴──────────▶ t
//
// The same upside down for speeding up. A limit is met with the first look at it and refined by the
// next ones; a slope that was shown raises a limit that was lower. Control thread; no allocation.

#include <array>
#include <cstddef>
#include <optional>

namespace roverd::nav {

class BrakeMeter {
 public:
  static constexpr double kTick_s = 0.02;

  enum class Way { Braking, SpeedingUp };
  explicit BrakeMeter(Way way) noexcept : way_(way) {}

  /// Once a tick. @param told_mps a size, of the direction in which it moves; told to stand: 0.
  /// @param seen_mps likewise; empty: nothing was told since the tick before (between two, a line)
  /// @param delay_s no command acts later than this
  void step(double told_mps, std::optional<double> seen_mps, double delay_s) noexcept;
  /// Another load may be on it: what was shown is not shown any more; a limit stays.
  void doubt() noexcept { shown_mps2_.reset(); }
  /// What another life of this program measured.
  void recall(double limit_mps2) noexcept { limit_mps2_ = limit_mps2; }
  /// Somebody else drove: the next look begins anew.
  void look_away() noexcept { filled_ = silent_ = 0; }

  /// It brakes no harder than this. Empty: it did whatever it was told.
  std::optional<double> limit_mps2() const noexcept { return limit_mps2_; }
  /// The limit was met, or found too low, since the start.
  bool looked() const noexcept { return looks_ > 0; }
  /// It brakes as hard as this, at least; since doubt().
  std::optional<double> shown_mps2() const noexcept { return shown_mps2_; }
  /// Of the limit; of one look or the mean of several.
  double sigma_mps2() const noexcept;

 private:
  static constexpr std::size_t kKept = 64;

  double told(std::size_t ticks) const noexcept { return told_[(at_ + kKept - ticks) % kKept]; }
  double seen(std::size_t ticks) const noexcept { return seen_[(at_ + kKept - ticks) % kKept]; }
  double sign() const noexcept { return way_ == Way::Braking ? 1.0 : -1.0; }
  bool wants(std::size_t delay) const noexcept;
  double asked_mps2(std::size_t delay) const noexcept;
  void take(double slope_mps2, double asked_mps2) noexcept;

  Way way_;
  std::array<double, kKept> told_{};
  std::array<double, kKept> seen_{};
  std::size_t at_ = 0;
  std::size_t filled_ = 0;
  std::size_t silent_ = 0;  ///< ticks since something was seen
  int pause_ = 0;           ///< ticks until the next look: looks overlap less
  int looks_ = 0;
  std::optional<double> limit_mps2_;
  std::optional<double> shown_mps2_;
};

}  // namespace roverd::nav
