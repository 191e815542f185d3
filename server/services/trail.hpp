#pragma once
// The way so far, for a page that is opened late: where the robot believed it was, and what its
// receiver said. In memory, from the program's start; the services' thread only.
//
//   snapshots, 20 Hz ─▶ Trail ─▶ two Tracks: decimated, bounded, in pieces
//
// A piece is what may be joined by a line. Where the position jumps, as when the estimator is set
// anew, the next piece begins: no way between them was driven.

#include <cstddef>
#include <optional>
#include <vector>

#include "base/geo.hpp"
#include "base/snapshot.hpp"
#include "base/time.hpp"

namespace roverd::services {

/// One decimated line.
class Track {
 public:
  static constexpr std::size_t kMost = 20'000;
  /// A point for every so many metres.
  static constexpr double kStep_m = 0.2;
  /// A good receiver that hardly moves has a track, too: after kPause a point this far from the
  /// last kSeen ones counts. That it must be far from all of them bounds the cloud of one that
  /// stands.
  static constexpr double kFineStep_m = 0.01;
  static constexpr base::Duration kPause = std::chrono::seconds(1);
  static constexpr std::size_t kSeen = 100;

  struct Point {
    base::LatLon at;
    base::Time stamp;
    bool begins = false;  ///< a new piece: no line leads here
  };

  /// Takes a sample, or passes over it. @param at valid. @param stamp never earlier than the last.
  /// @param reach_m farther than this from the last point is a jump
  void add(base::LatLon at, base::Time stamp, double reach_m);
  /// Oldest first, at most kMost; the first one begins a piece.
  const std::vector<Point>& points() const noexcept { return points_; }

 private:
  bool unseen(base::LatLon at) const;
  void thin();

  std::vector<Point> points_;
  base::Time looked_;  ///< when the fine step was tried last
};

class Trail {
 public:
  /// The estimate jumps where its own speed does not explain the way: corrections move it by less
  /// than kSlack_m at once, and samples are much less than kAhead_s apart.
  static constexpr double kSlack_m = 2.0;
  static constexpr double kAhead_s = 2.0;
  /// An older pose is not where the robot is.
  static constexpr double kStale_s = 1.0;
  /// A receiver does not always say its speed. Its points are drawn as dots, so little hangs on it.
  static constexpr double kReceiverReach_m = 10.0;

  /// Unknown and stale positions add nothing; a receiver's position counts once.
  void take(const base::Snapshot& snapshot);

  const Track& estimated() const noexcept { return estimated_; }
  const Track& received() const noexcept { return received_; }

 private:
  Track estimated_;
  Track received_;
  std::optional<base::Time> fix_;  ///< stamp of the receiver's last position
};

}  // namespace roverd::services
