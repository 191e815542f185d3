#pragma once
// A world made ready: its plants planted, its walls built, all of it in a grid of cells, so that a
// ray passes by what is far from it. Immutable; any number of threads may cast at once, each with a
// Moment of its own.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/world/draw.hpp"
#include "sim/world/shape.hpp"
#include "sim/world/terrain.hpp"
#include "sim/world/world.hpp"

namespace roverd::sim::world {

inline constexpr int kNothing = -1;
inline constexpr int kGround = -2;

struct Ray {
  Vec3 from;
  Vec3 dir;  ///< unit
};

struct Hit {
  double range_m = 0.0;
  int thing = kNothing;  ///< number in World::things, or one of the two above
  bool leaf = false;
  double cosine = 1.0;  ///< of the angle to the face's normal
  double reflect = 0.0;
  bool any() const noexcept { return thing != kNothing; }
};

/// Where all that moves is at one time. Cheap to make anew.
struct Moment {
  double at_s = 0.0;
  std::vector<Shape> shapes;
};

class Scene {
 public:
  /// The ground alone: level, nothing on it.
  Scene() : Scene(World{}) {}
  explicit Scene(World world);

  const World& world() const noexcept { return world_; }
  const Terrain& terrain() const noexcept { return terrain_; }
  std::size_t pieces() const noexcept { return shapes_.size(); }
  /// "wall", "the gate", "ground"; of Hit::thing.
  std::string name_of(int thing) const;
  /// The number of the person or animal that is called so.
  std::optional<std::size_t> mover(std::string_view name) const;
  /// It begins its path at that time, from its first point. Nothing where nobody is called so.
  void begin_walk(std::string_view name, double at_s);

  /// @param at_s since the start of the world.
  Moment at(double at_s) const;
  void move_to(Moment& moment, double at_s) const;

  /// What the ray meets first within max_m. Leaves and grass are drawn: the same key meets the same
  /// ones. Exact otherwise (of the ground see Terrain::meet). From inside a solid: range 0.
  Hit cast(const Ray& ray, double max_m, const Moment& moment, Draw& draw) const noexcept;
  /// The same without the grid, every shape in turn: what tests compare with.
  Hit cast_slowly(const Ray& ray, double max_m, const Moment& moment, Draw& draw) const noexcept;

  /// Calls see(const Shape&) at least once for each shape whose plan comes nearer than reach_m to
  /// the place, what moves included; some may come twice, and farther ones too.
  template <class See>
  void near(Vec2 at, double reach_m, const Moment& moment, See&& see) const {
    for (const Shape& shape : moment.shapes) see(shape);
    if (columns_ == 0) return;
    const int west = column_of(at.x - reach_m);
    const int east = column_of(at.x + reach_m);
    const int south = row_of(at.y - reach_m);
    const int north = row_of(at.y + reach_m);
    for (int row = south; row <= north; ++row) {
      for (int column = west; column <= east; ++column) {
        const std::size_t cell = cell_of(column, row);
        for (std::uint32_t i = begins_[cell]; i < begins_[cell + 1]; ++i) see(shapes_[held_[i]]);
      }
    }
  }

 private:
  void build();
  void index();
  int column_of(double x) const noexcept;  ///< cut to the grid
  int row_of(double y) const noexcept;
  std::size_t cell_of(int column, int row) const noexcept {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  void meet(const Shape& shape, const Ray& ray, std::uint64_t key, Hit& best,
            const Shape*& met) const noexcept;
  void walk(const Ray& ray, std::uint64_t key, Hit& best, const Shape*& met) const noexcept;
  Hit finish(const Ray& ray, double max_m, double grass_m, Hit best,
             const Shape* met) const noexcept;

  World world_;
  Terrain terrain_;
  std::vector<Shape> shapes_;
  std::vector<std::uint32_t> movers_;  ///< numbers of things

  double cell_m_ = 1.0;
  Vec2 corner_;  ///< south-west of the grid
  int columns_ = 0;
  int rows_ = 0;
  double top_m_ = 0.0;                 ///< no shape is higher
  double bottom_m_ = 0.0;              ///< nor lower
  std::vector<std::uint32_t> begins_;  ///< cell → its first in held_
  std::vector<std::uint32_t> held_;    ///< numbers of shapes
  std::vector<float> tops_;            ///< of each cell
};

/// What a thing consists of, standing still. @param out gets it.
void build_thing(const World& world, const Terrain& terrain, std::uint32_t thing,
                 std::vector<Shape>& out);
/// The same of what moves, as it is at_s.
void build_mover(const World& world, const Terrain& terrain, std::uint32_t thing, double at_s,
                 std::vector<Shape>& out);
bool moves(Kind kind) noexcept;

/// Place and direction on a path at a time.
struct OnPath {
  Vec2 at;
  double yaw_rad = 0.0;
  double speed_mps = 0.0;
  double gone_m = 0.0;  ///< way so far: the legs' swing
};
OnPath on_path(const Thing& thing, double at_s) noexcept;

}  // namespace roverd::sim::world
