#pragma once
// What the shelf keeps of a map beside its picture: about.json, as text. Pure.

#include <string>
#include <string_view>

#include "atlas/map_files.hpp"
#include "base/result.hpp"
#include "maps/words.hpp"

namespace roverd::maps {

inline constexpr std::size_t kLargestAbout = 8 * 1024 * 1024;  ///< bytes; all areas fit

struct Kept {
  About about;        ///< without id and size
  std::string image;  ///< the picture's file name in the map's folder
  atlas::MapMode mode = atlas::MapMode::Trinary;

  /// As the picture is to be read.
  atlas::MapWords words() const;
};

std::string about_text(const Kept& kept);
/// @return Malformed: no JSON; Invalid: a member is missing or cannot be, with its name
base::Result<Kept> about_from(std::string_view text);

}  // namespace roverd::maps
