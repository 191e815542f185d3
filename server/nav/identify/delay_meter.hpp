#pragma once
// How long it takes from a command to its motion, by trying every answer at once.
//
//   sent       ──╱──╲────────      R(d) = what a straight line y = g·x(t − d) leaves unexplained
//   measured   ─────╱──╲─────      the delay is where R is least; how sharp that valley is, against
//                 ◀d▶              what is left at its bottom, says how sure it is
//
// Both are freed of everything slower than a second (a slope, a bias, slip), so that gain and
// offset do not matter; both by the same filter, which delays both alike. What was heard is
// forgotten slowly, and only while something new is heard. A vehicle that answers with a lag τ
// after a delay T is one with the delay T + τ. Control thread; no allocation; about 0.2 us a tick.

#include <array>
#include <cstddef>
#include <optional>

namespace roverd::nav {

struct DelayFound {
  double delay_s = 0.0;
  double sigma_s = 0.0;  ///< > 0
  double gain = 0.0;     ///< motion for command
};

class DelayMeter {
 public:
  static constexpr double kTick_s = 0.02;
  static constexpr double kMost_s = 0.8;

  /// @param excited of the command's filtered square: less is silence, and nothing is learned of it
  explicit DelayMeter(double excited) noexcept : excited_(excited) {}

  /// What is sent at this tick, once each tick. @param gentle a change a second beyond which the
  /// vehicle may not follow any more: that is not its delay, and not looked at
  void sent(double x, double gentle) noexcept;
  /// Before sent() of the tick. @param age_s of the measurement, since the tick's time
  void measured(double y, double age_s, bool counts) noexcept;
  /// The past is of another vehicle.
  void forget() noexcept;

  /// Empty: not known well enough.
  std::optional<DelayFound> found() const noexcept;

 private:
  static constexpr std::size_t kCandidates = 41;  // 0 to kMost_s
  static constexpr std::size_t kKept = 64;

  double before(double age_ticks) const noexcept;

  double excited_;
  std::array<double, kKept> sent_{};  ///< filtered
  std::size_t at_ = 0;
  double raw_x_ = 0.0;
  double slow_x_ = 0.0;
  double slow_y_ = 0.0;
  int since_ = 0;  ///< ticks since something was measured
  int rough_ = 0;  ///< ticks that are not looked at
  bool heard_ = false;
  std::array<double, kCandidates> xx_{}, xy_{};
  double yy_ = 0.0;
  double weight_ = 0.0;  ///< ticks that count
};

}  // namespace roverd::nav
