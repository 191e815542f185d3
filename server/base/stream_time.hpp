#pragma once
// What a stream of bytes says of its own time: for files that were kept without time stamps.

#include <cstdint>
#include <functional>
#include <optional>

#include "base/bytes.hpp"

namespace roverd::base {

/// One reading of a clock of the device that spoke. Differences count, so any origin will do.
struct StreamTime {
  /// Clocks of one stream that do not share their origin; each is followed by itself.
  enum class Clock { TimeOfDay, TimeOfWeek, Samples };
  Clock clock = Clock::TimeOfDay;
  double s = 0.0;
  double period_s = 86'400.0;  ///< it begins again at 0 after this long
};
inline constexpr std::size_t kStreamClocks = 3;

/// Up to `end` (bytes since the beginning of the stream) it may be cut: no message goes on there.
/// The message that ends there tells this time, if any.
struct StreamMark {
  std::uint64_t end = 0;
  std::optional<StreamTime> time{};
};

using OnStreamMark = std::function<void(const StreamMark&)>;
/// Is handed all of a stream, one part after the other, and tells the marks in order. Has state.
using StreamClock = std::function<void(Bytes, const OnStreamMark&)>;

}  // namespace roverd::base
