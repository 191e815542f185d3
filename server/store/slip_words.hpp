#pragma once
// Where the ground gave way.

#include <cstdint>
#include <optional>
#include <string_view>

#include "base/geo.hpp"
#include "base/time.hpp"

namespace roverd::store {

/// Slip: the wheels counted more than was driven. Side: it slid sideways. Dug: the wheels turned
/// and it stood, or it made no progress.
enum class SlipKind { Slip, Side, Dug };
std::string_view to_string(SlipKind kind) noexcept;  // slip side dug

/// One place, and what happened there.
struct Slip {
  std::int64_t id = 0;
  base::LatLon at;
  base::WallTime time;  ///< the last time
  SlipKind kind = SlipKind::Slip;
  double percent = 0.0;  ///< the most: of the wheels' way that was not driven; or slid aside
  int times = 1;
};

/// What lies in it; west > east: across the date line.
struct Box {
  double west = -180.0;
  double south = -90.0;
  double east = 180.0;
  double north = 90.0;
};

struct SlipFilter {
  std::optional<base::WallTime> since;  ///< only later ones
  std::optional<Box> box;
};

}  // namespace roverd::store
