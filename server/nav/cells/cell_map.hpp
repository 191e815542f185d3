#pragma once
// Points of any number of clouds, kept as cells: how many points fell into each cube, their mean
// and how they spread about it. Nothing else of a point is kept, so a place costs the same however
// often it was seen.
//
// Frame M: the map's own, x y z in metres, z up. All is in one frame; moving clouds into it is the
// caller's.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace roverd::nav::cells {

/// Points in one frame, metres. Those that are not numbers are allowed and say nothing.
using Cloud = std::vector<Eigen::Vector3f>;

/// Where a table of 2^bits slots looks for a key first: of a product (Knuth) the upper bits depend
/// on every bit of the key, the lower ones on those below them alone. Twice, for once is a lattice
/// of the axes, in which the cells of a wall fall together. Pure.
/// @param bits 1 to 63
constexpr std::size_t first_slot(std::uint64_t key, int bits) noexcept {
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15U;
  key *= kGolden;
  key ^= key >> 32U;
  return static_cast<std::size_t>((key * kGolden) >> (64 - bits));
}

/// From 64-bit keys to indices below 2^31: open addressing, grows by itself when three quarters of
/// its slots are taken.
class KeyTable {
 public:
  explicit KeyTable(std::size_t expected = 512);
  /// @return the index that belongs to the key; -1 where none does.
  std::int32_t find(std::uint64_t key) const noexcept;
  /// @return the key's index; `fresh` where it had none, which it has from now on.
  std::int32_t find_or_add(std::uint64_t key, std::int32_t fresh);

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::int32_t at = -1;
  };
  void grow();
  std::size_t place(std::uint64_t key) const noexcept;
  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

/// One cube's points. Spread is the sum over the points of (p - mean)(p - mean)ᵀ, m²: xx xy xz yy
/// yz zz. Of one point it is zero.
struct Cell {
  double points = 0.0;
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  std::array<double, 6> spread_m2{};
};

/// All its values are numbers, and there are points in it.
bool finite(const Cell& c) noexcept;

/// Two cells as one (Chan, Golub, LeVeque 1979: sums about the common mean). Pure.
void merge(Cell& into, const Cell& more) noexcept;

/// @return spread / points as a matrix; zero without points.
Eigen::Matrix3d covariance_m2(const Cell& c) noexcept;

/// Which cube a point lies in. 21 bits an axis: beyond a million cells from the origin there is
/// none.
struct CellIndex {
  std::int32_t x = 0, y = 0, z = 0;
};
std::uint64_t key_of(const CellIndex& c) noexcept;
/// So far from the origin, along each axis, points have cells.
double reach_m(double cell_m) noexcept;
/// @return false where the point is no number or too far away.
bool index_of(const Eigen::Vector3d& p_m, double cell_m, CellIndex& out) noexcept;

/// Not shared between threads.
class CellMap {
 public:
  /// More than these are not taken: 10 million, about 1 GB.
  static constexpr std::size_t kMaxCells = 10'000'000;

  /// @param cell_m edge of a cell, (0, 100]
  explicit CellMap(double cell_m = 0.2);

  struct Added {
    std::size_t taken = 0;
    std::size_t no_number = 0;  ///< NaN, infinite, or more than a million cells away
    std::size_t no_room = 0;    ///< would have needed a cell too many
  };
  /// Any number of points, in M.
  Added add(std::span<const Eigen::Vector3f> cloud);
  /// Takes address space for so many cells, so that growing needs none twice. Memory is used by
  /// what is added alone.
  void expect(std::size_t cells);
  /// One cell as written by another map. It goes where its mean lies. @return false: no room, or
  /// no number in it
  bool add(const Cell& cell);

  double cell_m() const noexcept { return cell_m_; }
  const std::vector<Cell>& cells() const noexcept { return cells_; }
  /// The same points in cells `times` as large. @param times at least 1
  CellMap coarser(int times) const;

 private:
  double cell_m_;
  KeyTable table_;
  std::vector<Cell> cells_;
};

}  // namespace roverd::nav::cells
