#pragma once
// The radio's switches as keys: what stands still for long enough, and has changed, acts once.
//
//   Unknown ──same position for debounce_s──▶ Settled(p) ──another for debounce_s──▶ Settled(q):
//   acts
//      ▲                                          │
//      └── a gap, lost() ─────────────────────────┘     the first position is only remembered
//
// A position between two detents counts as the one before. Pure but for its memory; time is an
// argument. Control thread.

#include <array>
#include <optional>
#include <utility>

#include "base/measurements.hpp"
#include "base/setting.hpp"
#include "robot/config.hpp"
#include "robot/radio/actions.hpp"

namespace roverd::robot {

using base::Time;

/// What one change asked for.
struct RadioKey {
  const RadioAction* action = nullptr;  ///< never null, never None or ByKnob
  const char* cause = "";               ///< "SWC middle"
};

/// Actions of the positions in which switches and knob stand; null: not known.
struct RadioPositions {
  const RadioAction* swa = nullptr;
  const RadioAction* swc = nullptr;
  const RadioAction* swd = nullptr;
  const RadioAction* knob = nullptr;
};

class RadioKeys {
 public:
  static constexpr std::size_t kKeys = 3;
  /// At most one per switch, in the order SWD, SWC, SWA; unused ones have no action.
  using Pressed = std::array<RadioKey, kKeys>;

  /// @param params checked. @param safety frames farther apart than its radio_timeout_s have lost
  /// the radio between.
  RadioKeys(base::Setting<RadioParams> params, base::Setting<SafetyParams> safety)
      : params_(std::move(params)), safety_(std::move(safety)) {}

  /// Every frame in order. @param swb the last position between detents.
  Pressed take(const base::RadioState& radio, base::Switch swb) noexcept;
  /// The radio is not to be believed: what it says next is only remembered.
  void lost() noexcept;

  RadioPositions positions(const base::RadioState& radio) const noexcept;

 private:
  struct Key {
    std::optional<base::Switch> settled;
    base::Switch candidate = base::Switch::Unknown;
    Time since{};
  };
  bool settles(Key& key, base::Switch position, Time stamp) const noexcept;
  RadioKey swa(base::Switch position) const noexcept;
  RadioKey swc(base::Switch position) const noexcept;
  RadioKey swd(base::Switch position) const noexcept;
  const RadioAction* by_knob(double vra) const noexcept;

  base::Setting<RadioParams> params_;
  base::Setting<SafetyParams> safety_;
  Key swa_key_, swc_key_, swd_key_;
  std::optional<Time> last_;
};

}  // namespace roverd::robot
