#pragma once
// What arrived and was not used, by cause, and how often what was used arrives. Bounded whatever
// comes in: at most kMost causes have their own line, kUnknownIds of them unknown ids; the rest
// is counted together. Pure state; adding allocates nothing.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "base/time.hpp"

namespace roverd::bunker {

enum class Cause {
  Remote,
  ErrorFrame,
  Extended,
  UnknownId,
  TooShort,
  BadValue,
  BadChecksum,
  Impossible,
  Frozen,
  ForeignCommand,
  NotThisProtocol,
};

/// A value that cannot be: "battery", 6553.5, " V".
struct Impossible {
  std::string_view what;
  double value = 0.0;
  std::string_view unit;
};

class Tally {
 public:
  static constexpr std::size_t kMost = 80;
  static constexpr std::size_t kUnknownIds = 16;

  void add(Cause cause, std::uint32_t id = 0) noexcept { add(cause, id, {}); }
  /// @param detail its texts must live for ever; of several values the first is shown.
  void add(Cause cause, std::uint32_t id, const Impossible& detail) noexcept;

  /// "0x221 too short" → 3, "unknown id 0x123" → 1, "impossible value in 0x211: battery 6553.5 V".
  std::map<std::string, std::uint64_t> words() const;

 private:
  struct Line {
    Cause cause{};
    std::uint32_t id = 0;
    Impossible detail{};
    std::uint64_t count = 0;
  };
  std::array<Line, kMost> lines_{};
  std::size_t used_ = 0;
  std::size_t unknown_ids_ = 0;
  std::uint64_t other_unknown_ = 0;
  std::uint64_t other_ = 0;
};

/// Frames a second by id, over the time between two askings (at least kWindow).
class Rates {
 public:
  static constexpr std::size_t kIds = 32;
  static constexpr base::Duration kWindow = std::chrono::milliseconds(400);

  void add(std::uint32_t id) noexcept;
  /// "0x221" → 50.0. Ids heard once stay listed.
  const std::map<std::string, double>& words(base::Time now);

 private:
  struct Slot {
    std::uint32_t id = 0;
    std::uint32_t count = 0;
  };
  std::array<Slot, kIds> slots_{};
  std::size_t used_ = 0;
  base::Time since_{};
  std::map<std::string, double> words_;
};

std::string id_text(std::uint32_t id);

}  // namespace roverd::bunker
