#pragma once
// How a recording is played.

#include <atomic>
#include <functional>
#include <memory>

#include "base/stream_time.hpp"
#include "base/time.hpp"

namespace roverd::link {

/// Several recordings of one run, played in step: their links share one of these, on any threads.
/// A recording whose stamps are not UTC begins with the earliest one. A link that is opened again
/// goes on where the run is by then.
struct ReplayTogether {
  base::Duration begin{};                   ///< of the run, since 1970
  std::atomic<base::Time::rep> started{0};  ///< when its playing began; 0: not yet
};

struct ReplayOptions {
  /// Recorded seconds per second; 1 is real time. 0: as fast as the program takes it. Not negative.
  double speed = 1.0;
  /// Begin again at the end, for ever, instead of closing.
  bool loop = false;
  /// Not with speed 0, nor with loop. Null: the file begins with its first item.
  std::shared_ptr<ReplayTogether> together{};
  /// Longer silences in a plain file are cut to this (recordings with stamps keep theirs).
  double longest_gap_s = 30.0;
  /// Makes what cuts and paces a plain file of bytes (no stamps of ours) by the device's own time.
  std::function<base::StreamClock()> make_clock{};
  /// Paces a plain file in which that finds no time.
  double fallback_bytes_per_s = 960.0;
};

}  // namespace roverd::link
