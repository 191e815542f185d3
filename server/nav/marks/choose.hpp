#pragma once
// Which source steers is decided by what is seen, and told; whoever wants another one sets it.
//
//   auto   landmarks before walls, the scan before the vision program
//
// Not to flicker: the one that steers keeps steering while it is seen; a better one must have been
// seen for kSure_s, and one that is lost is waited for kPatience_s. Pure but for its state; time is
// an argument.

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "base/time.hpp"

namespace roverd::nav::marks {

/// In the order of preference, the last first.
enum class Guide { None, WallByVision, WallByScan, Landmarks };
inline constexpr std::size_t kGuides = 4;
std::string_view to_string(Guide g) noexcept;  // none wall_by_vision wall_by_scan landmarks
/// Empty: no such word. "auto" is no guide.
std::optional<Guide> guide_from(std::string_view word) noexcept;

struct InSight {
  bool landmarks = false;
  bool wall_by_scan = false;
  bool wall_by_vision = false;
};

class Chooser {
 public:
  static constexpr double kSure_s = 0.5;
  static constexpr double kPatience_s = 1.0;

  /// @param only nothing else steers; empty: by what is seen.
  Guide step(const InSight& seen, std::optional<Guide> only, base::Time now) noexcept;
  Guide now() const noexcept { return now_; }

 private:
  struct Watch {
    std::optional<base::Time> since;  ///< seen without a gap
    std::optional<base::Time> last;
  };
  std::array<Watch, kGuides> watches_{};
  Guide now_ = Guide::None;
};

}  // namespace roverd::nav::marks
