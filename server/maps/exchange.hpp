#pragma once
// Maps as they come from other programs and go to them, and as people are shown them. Pure; what is
// large takes its time: beside the web thread.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "maps/words.hpp"
#include "nav/cells/map_file.hpp"
#include "nav/chart/map.hpp"

namespace roverd::maps {

struct Upload {
  nav::chart::OccupancyMap map;
  /// Of the yaml: what it says besides, by name. Of a cloud: what of it was left out.
  std::vector<std::string> passed_over;
  std::vector<std::uint8_t> solid;  ///< its third dimension as a PCD file; empty: it has none
  /// What exported_yaml() wrote before the words; foreign files have none.
  std::string name{};  ///< any bytes; empty: none
  std::optional<Anchor> anchor{};
};

/// Both files of a map server's map. Which picture the yaml names does not matter. Invalid, naming
/// the file and its field, line or byte: "/yaml/origin", "/image/size", "/image/byte 17". An anchor
/// in its comments that cannot be is left out as a whole, and named in passed_over ("#
/// anchor_lat").
base::Result<Upload> read_upload(std::string_view yaml, std::string_view picture);

/// Of a map that comes as a file: what such a one takes to be read, drawn and written stays below
/// 600 MB, for the same process drives (docs/place.md). Ten hectares and more.
inline constexpr std::size_t kMostSentCells = 3'000'000;

/// A map in three dimensions: a PCD file, as cells. Invalid, naming the byte or line:
/// "/cloud/byte 17"; or that it has more than kMostSentCells.
base::Result<nav::cells::ReadMap> read_cloud(std::string_view pcd);
/// The same with its plane, to be kept. Invalid: it has none. What `read` holds is let go of.
base::Result<Upload> solid_upload(nav::cells::ReadMap read);

/// The words of an exported map, for a picture of that file name, with comments.hpp before them.
std::string exported_yaml(const nav::chart::OccupancyMap& map, const About& about,
                          const std::string& image);
/// Its picture: what is doubtful stays as it is, what is forbidden is drawn as occupied.
base::Result<std::string> exported_pgm(nav::chart::OccupancyMap map,
                                       const std::vector<Area>& forbidden);

struct Shown {
  std::string pgm;
  int factor = 1;  ///< so many cells to a side are one
};
/// See thinned().
Shown shown(const nav::chart::OccupancyMap& map, const std::vector<Area>& forbidden,
            std::size_t most);

}  // namespace roverd::maps
