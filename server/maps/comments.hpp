#pragma once
// What is told of a map before the words of its yaml, as comments, for map servers have no words
// for it: its name, and where it lies. Called as in [map] of the configuration.
//
//   # name: shed
//   # anchor_lat: 58.378
//   # anchor_lon: 26.729
//   # anchor_heading_deg: 45.5
//   # anchor_accuracy_m: 0.25            without: as Anchor has it
//   # anchor_heading_accuracy_deg: 1     likewise
//
// Pure. Comments of other programs are passed over.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "maps/words.hpp"

namespace roverd::maps {

std::string comments_of(const About& about);

struct Comments {
  std::string name;  ///< any bytes but line ends, trimmed; empty: none
  std::optional<Anchor> anchor;
  /// "# anchor_lat": is missing, comes twice or cannot be; then there is no anchor.
  std::vector<std::string> wrong;
};
/// Of the lines before the first that is neither empty nor a comment.
Comments read_comments(std::string_view yaml);

}  // namespace roverd::maps
