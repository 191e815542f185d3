#pragma once
// The lines between a study and somebody else's plant; docs/studies.md shows them. Pure.

#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.hpp"
#include "sim/foreign.hpp"

namespace roverd::study {

/// What a plant is told before it moves.
struct PlantHello {
  std::string vehicle;
  std::uint64_t seed = 1;
  bool steered = false;  ///< a car; else driven by side
  double track_width_m = 0.6;
  double wheelbase_m = 1.3;
  double heading_deg = 0.0;
};

inline constexpr std::size_t kMaxPlantLine = 64 * 1024;

/// Both without the line end.
std::string hello_line(const PlantHello& hello);
std::string order_line(const sim::ForeignOrder& order, bool steered);

struct PlantSaid {
  sim::ForeignState state;
  bool own_gnss = false;  ///< only asked for in the first line
};

/// @param first the answer to the hello. Malformed or Invalid, with all that is wrong.
base::Result<PlantSaid> read_plant_line(std::string_view line, const PlantHello& hello, bool first);

}  // namespace roverd::study
