#pragma once
// Can a sensor be relied on: how often it tells, how old its last word is, how much of it says
// something.
//
//   Blind      silent, or no place of the body is known for it, or too much unknown, or the glass
//              blocked, or it says itself that its data are not good
//   Degraded   slow, half as much unknown, the glass dirty
//   Ok

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/sight.hpp"
#include "nav/sense/params.hpp"
#include "nav/sense/reduce.hpp"

namespace roverd::nav::sense {

enum class Eye : std::uint8_t { Ok, Degraded, Blind };
std::string_view to_string(Eye eye) noexcept;  // ok degraded blind

struct Fitness {
  Eye eye = Eye::Blind;
  std::string reason;  ///< in words; empty when Ok
  double rate_hz = 0.0;
  double age_s = 0.0;         ///< of the last piece; of the watch itself before the first
  double unknown_part = 0.0;  ///< of its last directions
  double bad_part = 0.0;
  base::Window window = base::Window::Unknown;
  std::uint64_t pieces = 0;
  std::uint64_t lost = 0;     ///< gaps in Sight::count
  std::uint64_t refused = 0;  ///< pieces that could not be used
};

/// One per sensor. Not shared between threads.
class HealthWatch {
 public:
  HealthWatch(const HealthParams& params, base::Time begun) : p_(params), begun_(begun) {}

  /// A piece came. @param counts of its reduction; empty: it was refused.
  void took(const base::Sight& sight, const std::optional<Counts>& counts, base::Time now) noexcept;
  Fitness at(base::Time now) const;

 private:
  static constexpr std::size_t kArrivals = 32;
  HealthParams p_;
  base::Time begun_;
  std::array<base::Time, kArrivals> arrivals_{};  ///< of the pieces that were of use
  Fitness last_{};
  std::uint64_t used_ = 0;
  std::uint64_t count_ = 0;
  bool good_ = true;
  bool placed_ = true;
};

}  // namespace roverd::nav::sense
