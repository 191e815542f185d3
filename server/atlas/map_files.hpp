#pragma once
// Maps as ROS's map server keeps them: a picture (.pgm) and a few words about it (.yaml). Read and
// written as the map_server of Nav2 does; the yaml by the library that it uses, too.
//
//   words       image, resolution, origin [x, y, yaw] of the lower left corner, negate,
//               occupied_thresh, free_thresh, mode (without one: trinary). Others are passed over,
//               and named.
//   picture     P5, or P2 (text); row 0 at the top; shade = value / greatest value
//   occupancy   p = 1 - shade, or the shade itself where negated
//   trinary     occupied where p > occupied_thresh, free where p < free_thresh, else unknown. One
//               difference: 205 of 255, which the map server writes for unknown, is unknown also
//               where free_thresh is above its p of 0.196 (0.25 was that program's own default
//               until 2025): what nobody has seen is not called free
//   scale       as trinary, but what lies between is 0 to 100 in proportion; nothing is unknown
//   raw         the value (of 255) is the cell's: 0 to 100, else unknown
//
// Source: the package nav2_map_server, map_io. Pure; foreign bytes are refused with the field, the
// line or the byte. Nothing is allocated before the number of cells is known to be allowed.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"
#include "nav/chart/map.hpp"

namespace roverd::atlas {

enum class MapMode : std::uint8_t { Trinary, Scale, Raw };
std::string_view to_string(MapMode m) noexcept;  // trinary scale raw

struct MapWords {
  std::string image;  ///< file name, from the folder of the yaml
  MapMode mode = MapMode::Trinary;
  double resolution_m = 0.05;
  nav::chart::Pose2 origin;  ///< of the lower left corner
  bool negate = false;
  double occupied_thresh = 0.65;
  double free_thresh = 0.196;  ///< 205 lies above it
  /// Lines of other names, which were passed over: kMostOthers at most, each cut to 40 bytes.
  std::vector<std::string> others{};
};
inline constexpr std::size_t kMostOthers = 20;

inline constexpr std::size_t kLargestWords = 64 * 1024;  ///< bytes of a yaml

/// @return Malformed: no yaml (with its line), or no table; Invalid: a field is missing or cannot
/// be ("/origin").
base::Result<MapWords> read_words(std::string_view yaml);
/// Seven lines. @param words finite; image: what is not a plain word is quoted.
std::string write_words(const MapWords& words);

/// Grey values, row after row from the top.
struct Picture {
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  std::uint32_t greatest = 255;  ///< white; 1 to 65535
  std::vector<std::uint16_t> values;
};

/// P5 or P2 with comments, 8 or 16 bits. @return Malformed with the byte: no such picture, cut, or
/// something follows it; TooLarge above nav::chart::kMostCells.
base::Result<Picture> read_pgm(base::Bytes file);
/// P5; two bytes a value above 255.
std::vector<std::uint8_t> write_pgm(const Picture& picture);

/// Both together. @return as OccupancyMap::make.
base::Result<nav::chart::OccupancyMap> map_of(const MapWords& words, const Picture& picture);

/// The picture of a map as the words say: mode and thresholds; in trinary doubtful cells become
/// unknown. @return Unsupported: scale and a cell that is unknown, which no grey value can say
/// (the map server needs a picture with transparency there).
base::Result<Picture> picture_of(const nav::chart::OccupancyMap& map, const MapWords& words);

}  // namespace roverd::atlas
