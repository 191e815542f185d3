#pragma once
// The rolling grid: what is known of the ground around the robot, by all sensors together. Cells
// lie fixed in the odometry's frame O; the window moves with the robot and takes no memory beyond
// its own.
//
//   Unknown ──seen free──▶ Free ──hit──▶ Occupied ──seen through clear_scans times──▶ Free
//      ▲                     │keep_free_s     │keep_hit_s
//      └─────────────────────┴────────────────┘  (out of sight; hits stay by default; what a
//                                                 sensor that is blind saw free, sooner)
//
// Blind is not free: a cell is free only where a ray passed low enough (sectors.hpp). Of what
// stands in a cell the heights are kept between which it was seen lately, in O: only a ray that
// passes between them and goes on says that it left (of what was met less than four times, a ray
// nearby as well: it may have been rain). Along the edges of what was met no height is known well
// enough for a moment to say so: a plane that rises over a box passes just above it. There rays
// must say it for 0.15 s; and for 0.5 s where they pass just beside the edges, or where nothing was
// met for so long that the heights may have drifted. What a ray passes above or below
// stays, and so does what sinks out of every sensor's view as the robot comes near, leans or
// climbs. (Where nothing tells how the body leans, its plane is taken for O's. What tells it may
// err by degrees while the robot brakes: of what stands on the ground a ray must say so over the
// body's plane as well, or a false lean would take away what is too low and near to be met.) What
// is too thin or too new to be believed (Passing) makes no cell occupied; but where something was
// believed, an echo in its cell or beside it says that it still stands there, however many rays
// pass it by.
//
// What a plane met on a hill before the ground was seen there is ground once it is (hills.hpp).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "nav/sense/hills.hpp"
#include "nav/sense/params.hpp"
#include "nav/sense/reduce.hpp"
#include "nav/sense/sectors.hpp"

namespace roverd::nav::sense {

enum class Known : std::uint8_t { Unknown, Free, Occupied, Drop };

/// What the control thread and the page read: a square of the grid at one time, immutable once
/// made.
struct Patch {
  struct Cell {
    Known known = Known::Unknown;
    std::uint8_t sensor = 0;   ///< number of the sensor that told it last
    std::uint16_t age_ds = 0;  ///< tenths of a second at `stamp`
  };
  base::Time stamp;
  double cell_m = 0.05;
  std::int32_t x0 =
      0;  ///< cell of the corner with the least x and y: it begins at x0 · cell_m in O
  std::int32_t y0 = 0;
  std::int32_t side = 0;
  std::vector<Cell> cells;  ///< rows of equal y, x upwards

  /// Outside of the patch: Unknown.
  Cell at(std::int32_t ix, std::int32_t iy) const noexcept {
    const auto x = static_cast<std::uint32_t>(ix - x0);
    const auto y = static_cast<std::uint32_t>(iy - y0);
    if (x >= static_cast<std::uint32_t>(side) || y >= static_cast<std::uint32_t>(side)) return {};
    return cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + x];
  }
};

/// Not shared between threads.
class Grid {
 public:
  explicit Grid(const GridParams& params);

  /// Takes one judged piece. @param pose X_OB of both. @param stamp not older than the last by more
  /// than a second. @param sensor its number, for Patch::Cell. @param hills what is known of the
  /// ground by now; null: nothing
  void take(const Reduced& in, const Sectors& sectors, std::uint8_t sensor,
            const Hills* hills = nullptr);
  /// Everything is unknown again: the odometry began anew.
  void forget() noexcept;

  Known at(double x_m, double y_m, base::Time now) const noexcept;
  /// @param reach_m half side; cut to the window. @param out its buffer is used again.
  /// @param free_for_s by the number of the sensor: older than this, what it told free is unknown;
  /// empty: as the parameters say of all of them
  void patch(const Pose2& about, double reach_m, base::Time now, Patch& out,
             std::span<const double> free_for_s = {}) const;

  double cell_m() const noexcept { return p_.cell_m; }
  std::int32_t side() const noexcept { return side_; }

 private:
  struct Cell {
    Known known = Known::Unknown;
    std::uint8_t misses = 0;  ///< scans that saw through it since it was hit
    std::uint8_t sensor = 0;
    std::uint8_t hits = 0;  ///< pieces that met it
    std::uint32_t ms = 0;   ///< since the first piece
  };
  /// Heights in O between which something was seen, and where in the cell it was met last: a ray
  /// falls by a centimetre within a cell, and one that grazes the far edge must not count.
  struct Span {
    float low_m = 0.0F;
    float top_m = 0.0F;
    float x = 0.0F;  ///< in cells, from the cell's corner
    float y = 0.0F;
    float top_body_m = 0.0F;  ///< as top_m, over the body's plane
    bool stands = false;      ///< on the ground
    bool by_planes = false;   ///< nothing but thin planes met it
    float now_low_m = 0.0F;   ///< of the last piece that met it
    float now_top_m = 0.0F;
    float now_body_m = 0.0F;
    std::uint32_t met_ms = 0;     ///< last
    std::uint32_t beside_ms = 0;  ///< since then rays say that it left
    std::uint32_t along_ms = 0;   ///< and those that pass no higher or lower than it was met
    std::uint8_t along = 0;       ///< pieces that say so
  };
  std::size_t index(std::int32_t ix, std::int32_t iy) const noexcept {
    return static_cast<std::size_t>(iy & mask_) * stride_ + static_cast<std::size_t>(ix & mask_);
  }
  Cell& cell(std::int32_t ix, std::int32_t iy) noexcept { return cells_[index(ix, iy)]; }
  const Cell& cell(std::int32_t ix, std::int32_t iy) const noexcept {
    return cells_[index(ix, iy)];
  }
  bool inside(std::int32_t ix, std::int32_t iy) const noexcept {
    return static_cast<std::uint32_t>(ix - x0_) < static_cast<std::uint32_t>(side_) &&
           static_cast<std::uint32_t>(iy - y0_) < static_cast<std::uint32_t>(side_);
  }
  std::uint32_t ms(base::Time t) const noexcept;
  Known known(const Cell& c, std::uint32_t now_ms) const noexcept;
  void move_to(const Pose2& body);
  void hit(const Reduced& in, bool thin, std::uint8_t sensor, std::uint32_t now_ms);
  /// Where ground is seen now: what planes alone met there, as high as it, was that.
  void uncover(const Reduced& in, const Hills& hills) noexcept;
  /// What this piece met together, or again and again, is no drop of rain.
  void make_sure();
  /// Something returned from there: what is taken there or beside it is not seen through now.
  void stay(std::int32_t ix, std::int32_t iy, std::uint8_t sensor, std::uint32_t now_ms) noexcept;
  void see_through(const Pose2& body, const Sectors& s, std::uint8_t sensor, std::uint32_t now_ms);
  /// One line of cells: from the `from`-th to before the `to`-th, away from (x, y) cells.
  struct Line {
    double x = 0.0;
    double y = 0.0;
    double dx = 1.0;
    double dy = 0.0;
    std::size_t from = 0;
    std::size_t to = 0;
  };
  void look_along(const Line& line, std::size_t sector, const Sectors& s, std::uint8_t sensor,
                  std::uint32_t now_ms) noexcept;
  /// Counts the piece. @param pass not None
  bool long_enough(std::size_t i, Sectors::Pass pass, std::uint32_t now_ms) noexcept;
  bool seen_through(std::size_t i, double d_m, std::uint64_t bit, std::size_t sector,
                    const Sectors& s, std::uint8_t sensor, std::uint32_t now_ms) noexcept;

  GridParams p_;
  std::int32_t side_;  ///< a power of two
  std::int32_t mask_;
  std::size_t
      stride_;  ///< from row to row: no power of two, which would share few lines of a cache
  std::int32_t x0_ = 0;
  std::int32_t y0_ = 0;
  base::Time begin_;
  bool begun_ = false;
  std::vector<Cell> cells_;
  std::vector<std::array<std::int32_t, 2>> met_;  ///< cells of the piece that is taken
  std::vector<Span> spans_;                       ///< of the cells that are Occupied
};

/// The patch as pairs of bytes for the stream: Known (two upper bits) and a run of 1 to 64 cells
/// (six lower bits: length − 1), row by row. Bounded by the number of cells.
std::vector<std::uint8_t> run_lengths(const Patch& patch);

/// Metres from every cell's middle to the nearest cell that is Occupied or Drop (or, if so asked,
/// Unknown); at most max_m. Exact (Felzenszwalb and Huttenlocher, Distance transforms of sampled
/// functions, 2012). @param out side x side, rows as the patch's.
void clearance(const Patch& patch, bool unknown_too, float max_m, std::vector<float>& out);

}  // namespace roverd::nav::sense
