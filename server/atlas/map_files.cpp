#include "atlas/map_files.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roverd::atlas {

namespace {

using base::Result;
using nav::chart::Cell;
using nav::chart::kFree;
using nav::chart::kOccupied;
using nav::chart::kUnknown;
using nav::chart::OccupancyMap;

/// What the map server writes for unknown cells; in a picture of more shades the same grey.
/// @param greatest 255 to 65535
std::uint16_t unknown_grey(const MapWords& words, std::uint32_t greatest = 255) noexcept {
  constexpr std::uint32_t kGrey = 205;
  const std::uint32_t grey = words.negate ? 255 - kGrey : kGrey;
  return static_cast<std::uint16_t>((grey * greatest + 127) / 255);
}

Cell cell_from(std::uint16_t value, std::uint32_t greatest, const MapWords& words) {
  const double shade = static_cast<double>(value) / static_cast<double>(greatest);
  if (words.mode == MapMode::Raw) {
    const double percent = std::round(shade * 255.0);
    return percent <= kOccupied ? static_cast<Cell>(percent) : kUnknown;
  }
  // With a free_thresh of 0.25 the map server reads its own grey of "unknown" as free.
  if (words.mode == MapMode::Trinary && greatest >= 255 && value == unknown_grey(words, greatest)) {
    return kUnknown;
  }
  const double p = words.negate ? shade : 1.0 - shade;
  if (p > words.occupied_thresh) return kOccupied;
  if (p < words.free_thresh) return kFree;
  if (words.mode == MapMode::Trinary) return kUnknown;
  const double span = words.occupied_thresh - words.free_thresh;
  const double part = span > 0.0 ? (p - words.free_thresh) / span : 1.0;
  return static_cast<Cell>(std::lround(100.0 * std::clamp(part, 0.0, 1.0)));
}

/// As the map server writes: free is 254, so that white stays for other uses.
std::uint16_t grey_of(Cell cell, const MapWords& words) {
  if (words.mode == MapMode::Raw) {
    return cell == kUnknown ? std::uint16_t{255} : static_cast<std::uint16_t>(cell);
  }
  long shade = 0;
  if (words.mode == MapMode::Scale) {
    shade = std::lround(255.0 * (100 - cell) / 100.0);
  } else {
    const bool free = cell <= nav::chart::kSurelyFree;
    const bool occupied = cell >= nav::chart::kSurelyOccupied;
    if (cell == kUnknown || (!free && !occupied)) return unknown_grey(words);
    shade = free ? 254 : 0;
  }
  return static_cast<std::uint16_t>(words.negate ? 255 - shade : shade);
}

}  // namespace

Result<OccupancyMap> map_of(const MapWords& words, const Picture& picture) {
  const nav::chart::MapShape shape{static_cast<std::int32_t>(picture.columns),
                                   static_cast<std::int32_t>(picture.rows), words.resolution_m,
                                   words.origin};
  std::vector<Cell> by_value(std::size_t{picture.greatest} + 1);
  for (std::uint32_t v = 0; v <= picture.greatest; ++v) {
    by_value[v] = cell_from(static_cast<std::uint16_t>(v), picture.greatest, words);
  }
  std::vector<Cell> cells(picture.values.size());
  const std::size_t columns = picture.columns;
  for (std::size_t top = 0; top < picture.rows; ++top) {
    const std::size_t row = picture.rows - 1 - top;
    for (std::size_t column = 0; column < columns; ++column) {
      cells[row * columns + column] = by_value[picture.values[top * columns + column]];
    }
  }
  return OccupancyMap::make(shape, std::move(cells));
}

Result<Picture> picture_of(const OccupancyMap& map, const MapWords& words) {
  const auto cells = map.cells();
  if (words.mode == MapMode::Scale &&
      std::find(cells.begin(), cells.end(), kUnknown) != cells.end()) {
    return base::fail(base::Code::Unsupported,
                      "a map with unknown cells cannot be kept in the mode scale: no grey value "
                      "says unknown",
                      {{"/mode", "must be trinary or raw"}});
  }
  Picture picture;
  picture.columns = static_cast<std::uint32_t>(map.columns());
  picture.rows = static_cast<std::uint32_t>(map.rows());
  picture.values.resize(cells.size());
  const std::size_t columns = picture.columns;
  for (std::size_t top = 0; top < picture.rows; ++top) {
    const std::size_t row = picture.rows - 1 - top;
    for (std::size_t column = 0; column < columns; ++column) {
      picture.values[top * columns + column] = grey_of(cells[row * columns + column], words);
    }
  }
  return picture;
}

}  // namespace roverd::atlas
