#pragma once
// Where the robot slipped or dug itself in, so that the next one knows: seen in the snapshots, kept
// by the store. The services' thread; nothing of it runs in the control loop.
//
//   slip   the wheels count a quarter more than was driven
//   side   it slides an eighth of its way aside
//   dug    the wheels turn and it stands, or a mission is blocked without progress
//
// A place is told once, and again after kStep_m or when it has become much worse. While the store
// is busy what happens is not kept.

#include <array>
#include <functional>
#include <optional>

#include "base/geo.hpp"
#include "base/snapshot.hpp"
#include "store/slip_words.hpp"

namespace roverd::services {

class SlipRecorder {
 public:
  static constexpr double kSlip = 0.25;  ///< of the wheels' way
  static constexpr double kSide = 0.125;
  static constexpr double kMoves_mps = 0.1;  ///< slower, nothing is measured
  static constexpr double kSure_m = 1.0;     ///< sigma of a place worth keeping
  static constexpr double kStep_m = 2.0;
  static constexpr double kWorse_pct = 15.0;

  std::function<void(store::Slip)> note;

  /// Every sample of the snapshot.
  void look(const base::Snapshot& s);

 private:
  struct Told {
    base::LatLon at;
    double percent = 0.0;
  };
  void tell(const base::Snapshot& s, store::SlipKind kind, double percent);

  std::array<std::optional<Told>, 3> told_;  ///< last, by kind; empty: it grips again
};

}  // namespace roverd::services
