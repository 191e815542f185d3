#pragma once
// Which members a kind of thing has in the file of a world, what they may be and what they are when
// left out: for whoever reads such a file and whoever writes it.

#include <string_view>
#include <vector>

#include "sim/world/world.hpp"

namespace roverd::sim::world {

/// A number of a thing: its name, where it is kept, its range.
struct Number {
  const char* name;
  double Thing::*at;
  double low;
  double high;
};
enum class Places { One, Line, Path };

struct KindRow {
  Kind kind;
  Places places;
  std::vector<Number> numbers;
  bool turned = false;  ///< has heading_deg
  Thing defaults{};
};

/// All of them, in the order of Kind.
const std::vector<KindRow>& kinds();

std::string_view word_of(Motion motion) noexcept;  // back loop once

}  // namespace roverd::sim::world
