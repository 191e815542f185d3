#pragma once
// A world as it is written down: what stands where, what moves, what the ground is like. Values
// only; scene.hpp makes of it what rays can meet. Metres east and north of the start, heights above
// the ground under the thing. The file format is described in docs/worlds.md.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "sim/world/vec.hpp"

namespace roverd::sim::world {

inline constexpr double kReach_m = 2'000.0;  ///< of any coordinate
inline constexpr std::size_t kMaxThings = 100'000;
inline constexpr std::size_t kMaxPoints = 1'000;    ///< of one thing
inline constexpr std::size_t kMaxPlants = 200'000;  ///< of all rows
inline constexpr std::size_t kMaxText = 32 * 1024 * 1024;

enum class Kind : std::uint8_t { Wall, Pole, Box, Cone, Bush, Row, Bar, Person, Animal, Tag };
std::string_view to_string(Kind kind) noexcept;

/// What one does at the end of its path.
enum class Motion : std::uint8_t { Once, Loop, Back };

/// Which members count follows from the kind:
///   wall    points, height, thickness            upright, along the points
///   bar     points, bottom, height, thickness    the same in the air: a beam, a branch
///   pole    points[0], radius, height
///   box     points[0] (middle), length, width, height, bottom, yaw
///   cone    points[0], radius (at the ground), height
///   bush    points[0], radius, height, density
///   row     points, spacing, width, height, gaps, bend, density
///   tag     points[0] (its middle), height of its middle, length (side of its black border), id,
///           yaw (where it looks): an AprilTag of tag36h11 on a thin plate
///   person, animal: points (path), speed, motion, pause, start; length, width, height
struct Thing {
  Kind kind = Kind::Box;
  std::string name;  ///< empty: its kind and number
  std::vector<Vec2> points;
  double height_m = 1.0;
  double bottom_m = 0.0;
  double thickness_m = 0.2;
  double radius_m = 0.1;
  double length_m = 1.0;
  double width_m = 1.0;
  double yaw_rad = 0.0;     ///< of its length, counter-clockwise from east
  double density_pm = 4.0;  ///< leaves: mean number of them that a ray meets on a metre of it
  double spacing_m = 0.5;   ///< from plant to plant
  double gaps = 0.0;        ///< share of plants that are missing
  double bend_m = 0.0;      ///< to the left, in the middle between the row's first and last point
  double speed_mps = 1.2;
  double pause_s = 0.0;  ///< at each end of the path
  double start_s = 0.0;  ///< stands at its first point until then
  Motion motion = Motion::Back;
  double reflect = 0.5;  ///< share of light that comes back, 0 black, 1 white
  double id = 0.0;       ///< of a tag: 0 .. 586
  friend bool operator==(const Thing&, const Thing&) = default;
};

/// Smooth unevenness: heights up to ±height_m, about so far from one knot to the next.
struct Uneven {
  double height_m = 0.0;
  double patch_m = 1.0;
  friend bool operator==(const Uneven&, const Uneven&) = default;
};
struct Bump {
  Vec2 at;
  double radius_m = 1.0;
  double height_m = 0.2;  ///< negative: a hollow
  friend bool operator==(const Bump&, const Bump&) = default;
};
/// Ground that lies lower, behind an edge: a ditch, a loading ramp, the end of a terrace.
struct Drop {
  std::vector<Vec2> points;  ///< polygon, either way round
  double depth_m = 0.5;
  friend bool operator==(const Drop&, const Drop&) = default;
};

struct Ground {
  double slope_rad = 0.0;
  double uphill_rad = 0.0;  ///< counter-clockwise from east
  double grass_m = 0.0;     ///< blades that a ray may meet, up to so high
  double reflect = 0.3;
  std::vector<Uneven> uneven;
  std::vector<Bump> bumps;
  std::vector<Drop> drops;
  friend bool operator==(const Ground&, const Ground&) = default;
};

struct World {
  std::string name;
  std::uint64_t seed = 1;  ///< of plants and unevenness
  Ground ground;
  std::vector<Thing> things;
  friend bool operator==(const World&, const World&) = default;
};

/// Reads the JSON text of a world. Anything unknown, missing, of the wrong type or out of its range
/// is an error that names the member ("/things/3/height_m must lie in 0.01 .. 100").
base::Result<World> read_world(std::string_view text);
/// The text that read_world reads; what has its default is left out.
std::string write_world(const World& world);

/// Of a row, those that are missing counted too.
std::size_t plants_of(const Thing& row) noexcept;

}  // namespace roverd::sim::world
