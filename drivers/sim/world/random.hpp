#pragma once
// Worlds by number, for studies: the same number gives the same world, everywhere and always.

#include <optional>
#include <string_view>

#include "sim/world/world.hpp"

namespace roverd::sim::world {

enum class RandomKind : std::uint8_t {
  Static,   ///< poles, boxes, cones, walls, bushes, bars: nothing moves
  Moving,   ///< the same, fewer, and people and animals that cross
  Grass,    ///< rough grass, nothing else
  Crowded,  ///< 10,000 things
};
/// static, moving, grass, crowded
std::string_view to_string(RandomKind kind) noexcept;

/// Within 25 m of the start (crowded: 100 m); within 2.5 m of the start stands nothing. The ground
/// is a little uneven, sometimes sloping.
World random_world(std::uint64_t seed, RandomKind kind);

/// "random:7", "random:7:moving"; nothing if it is not of that form.
std::optional<World> random_world_named(std::string_view text);

}  // namespace roverd::sim::world
