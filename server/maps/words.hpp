#pragma once
// What is known of a kept map of the plane, and what people may change of it.
//
// Frame M: the map's own, metres, yaw left positive. Angles on the earth are compass headings in
// degrees, as people say them. Values.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/geo.hpp"
#include "base/time.hpp"
#include "nav/chart/map.hpp"

namespace roverd::maps {

/// The map of the configuration; kept ones count from 1.
inline constexpr std::int64_t kConfigured = 0;

inline constexpr std::size_t kMostMaps = 200;
/// Rows, and columns: 2 km at 5 cm. An area is drawn row by row.
inline constexpr std::int32_t kLongestSide = 40'000;
inline constexpr std::size_t kMostEdits = 50;       ///< of one change
inline constexpr std::size_t kMostForbidden = 100;  ///< areas of a map
inline constexpr std::size_t kMostCorners = 500;    ///< of an area
inline constexpr double kFarthest_m = 2e6;          ///< of a corner from the map's origin

/// Where the map lies on the earth.
struct Anchor {
  base::LatLon at;                    ///< of x = y = 0
  double heading_deg = 90.0;          ///< compass heading of the x axis, 0 to 360
  double accuracy_m = 0.3;            ///< 1 sigma, 0 to 10
  double heading_accuracy_deg = 1.0;  ///< 1 sigma, 0 to 45
};

struct Corner {
  double x_m = 0.0;  ///< in M
  double y_m = 0.0;
};
using Area = std::vector<Corner>;  ///< at least three; closed by itself

struct About {
  std::int64_t id = 0;
  std::string name;
  base::WallTime created;
  std::int64_t revision = 1;  ///< one more with every change
  nav::chart::MapShape shape;
  std::optional<Anchor> anchor;  ///< empty: not known
  /// What a person forbade. Not in the cells: nothing stands there that a scanner could see.
  std::vector<Area> forbidden;
  std::uint64_t size_bytes = 0;  ///< on the disk
  bool solid = false;            ///< it has a third dimension
  std::string problem;           ///< why it cannot be used now: "its picture is gone"; else empty
};

/// What becomes of a new map whose name another one has: missions count from a map by its name.
enum class IfTaken : std::uint8_t {
  Refuse,  ///< a person gave it
  Number   ///< nobody did: "hall 2" instead
};

/// The cells whose middle lies inside become free or occupied; an area that is forbidden is kept
/// beside them.
struct Edit {
  enum class Kind : std::uint8_t { Erase, Wall, Forbid };
  Kind kind = Kind::Erase;
  Area area;
};

/// A map that is being driven.
struct Making {
  std::size_t scans = 0;
  std::size_t clouds =
      0;  ///< of a lidar of several rows: from five on the map has three dimensions
  double way_m = 0.0;
  std::string trouble;  ///< why nothing more is taken; empty: it goes on
};
struct Made {
  nav::chart::OccupancyMap map;
  std::optional<Anchor> anchor;       ///< where the satellites were good on the way
  std::vector<std::uint8_t> solid{};  ///< its third dimension as a PCD file; empty: it has none
};

/// What is empty stays.
struct Change {
  std::optional<std::int64_t> of_revision;  ///< refused if the map is another one by now
  std::optional<std::string> name;
  bool changes_anchor = false;
  std::optional<Anchor> anchor;                ///< where it changes; empty: not known any more
  std::optional<std::vector<Area>> forbidden;  ///< all that are from now on, before the edits
  std::vector<Edit> edits;                     ///< one after the other

  /// Whether it matters to whoever looks for himself in the map, and to missions that count from
  /// it: they do by its name. @param named what it is called by now
  bool moves(const std::string& named) const noexcept {
    if (changes_anchor || (name && *name != named)) return true;
    for (const Edit& e : edits) {
      if (e.kind != Edit::Kind::Forbid) return true;
    }
    return false;
  }
};

}  // namespace roverd::maps
