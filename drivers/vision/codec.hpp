#pragma once
// Datagrams of a vision program: text, one datagram an image, six fields between five colons.
//
//   cone#box#door: 0 2: 0.5 0.1 2 -0.3 0.1 3: 1 0.2 1.5: 0.9 0 2 -1 0 0: 5200
//   0              1    2                     3          4               5
//
//   0 names, between #
//   1 those that were recognised: 0 is the first of field 0
//   2 landmarks: x y z each, one for each of field 1
//   3 obstacles: x y z each
//   4 planes: centre and unit normal, six numbers each
//   5 plane sizes
//
// Every number has exactly one blank before it and nothing else beside it; a field without numbers
// is empty. Metres in the camera's axes: x right, y down, z ahead. Pure.

#include <cstdint>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "base/vision.hpp"

namespace roverd::vision {

using base::Bytes;

inline constexpr std::size_t kMostNames = 64;
inline constexpr std::size_t kLongestName = 32;
inline constexpr std::size_t kMostLandmarks = 256;
inline constexpr std::size_t kMostObstacles = 1024;
inline constexpr std::size_t kMostPlanes = 256;
inline constexpr double kFarthest_m = 1000.0;  ///< of any coordinate
inline constexpr double kLargestSize = 1e9;    ///< of a plane
inline constexpr double kNormalOff = 0.05;     ///< a unit normal's length may be so far off 1

/// x right, y down, z ahead.
struct Point {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  friend bool operator==(const Point&, const Point&) = default;
};
struct Landmark {
  std::size_t name = 0;  ///< of Datagram::names
  Point at;
  friend bool operator==(const Landmark&, const Landmark&) = default;
};
struct Plane {
  Point centre;
  Point normal;
  double size = 0.0;
  friend bool operator==(const Plane&, const Plane&) = default;
};
struct Datagram {
  std::vector<std::string> names;
  std::vector<Landmark> landmarks;
  std::vector<Point> obstacles;
  std::vector<Plane> planes;
  friend bool operator==(const Datagram&, const Datagram&) = default;
};

/// Why a datagram is refused, in the order in which it is looked for.
enum class Fault : std::uint8_t {
  None,
  Fields,     ///< not six
  Name,       ///< empty, too long, too many, or not printable ASCII
  Blank,      ///< a number without exactly one blank before it
  Number,     ///< none, or not finite
  Range,      ///< a coordinate or size beyond what can be
  Index,      ///< no whole number, or of no name
  TooMany,    ///< landmarks, obstacles or planes
  Landmarks,  ///< not three numbers for each index
  Triples,    ///< obstacles: a rest of one or two
  Planes,     ///< a rest of one to five
  Sizes,      ///< not one for each plane
  Normal,     ///< its length is not 1
};
inline constexpr std::size_t kFaults = 13;
/// In words: "a number that is none".
const char* to_string(Fault fault) noexcept;

struct Decoded {
  Fault fault = Fault::None;
  std::size_t field = 0;  ///< 0 to 5, where the fault is
  std::size_t byte = 0;   ///< likewise, from 0
  Datagram datagram{};    ///< empty with a fault
};
Decoded decode(Bytes bytes);
/// "a number that is none: field 2 (landmarks), byte 27"
std::string describe(const Decoded& decoded);

/// The text of a datagram; what decode gave is decoded as the same. @param d within the bounds.
std::string encode(const Datagram& d);

/// In S, FLU; normals of length 1. Sensor, stamp and count are the caller's.
base::Vision seen(const Datagram& d);

}  // namespace roverd::vision
