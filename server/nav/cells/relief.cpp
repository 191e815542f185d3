#include "nav/cells/relief.hpp"

#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>
#include <nanoflann.hpp>

namespace roverd::nav::cells {

namespace {

constexpr double kAcross = 0.16;    // cells: deviation across a surface
constexpr double kAlong = 5.0;      // cells
constexpr double kFewPoints = 5.0;  // fewer say nothing of a coarse cell's shape
constexpr double kThinnest = 0.01;  // share of the largest variance
constexpr double kManyPoints = 8.0;
constexpr double kThin = 0.1;        // of the middle variance
constexpr double kWide = 0.15;       // cells: deviation of points all over it is twice that
constexpr std::size_t kInLeaf = 10;  // of the tree

/// Of the direction of least variance among so many neighbours. Source: first-order perturbation of
/// a sample covariance's eigenvectors (Anderson, An Introduction to Multivariate Statistical
/// Analysis, 13.5).
double tilt_rad2(const Eigen::Vector3d& v) noexcept {
  const double apart = std::max(v(1) - v(0), 1e-12);
  return std::min(1.0, std::max(v(0), 0.0) * v(1) / (double(Relief::kNeighbours) * apart * apart));
}

/// The points of a cell tell its direction by themselves: of a thin wall's two faces, which are
/// each other's neighbours, each one its own.
bool is_a_surface(const Cell& cell, double cell_m) {
  if (cell.points < kManyPoints) return false;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(covariance_m2(cell), Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& v = axes.eigenvalues();
  return v(0) < kThin * v(1) && v(1) > kWide * kWide * cell_m * cell_m;
}

/// A surfel with the axes of what was measured and other variances, which the rule gives from the
/// measured ones (ascending).
template <class Rule>
Surfel shaped(const Eigen::Vector3d& mean_m, const Eigen::Matrix3d& measured, Rule rule) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(measured);
  const Eigen::Vector3d wanted = rule(Eigen::Vector3d(axes.eigenvalues()));
  return {mean_m, axes.eigenvectors() * wanted.asDiagonal() * axes.eigenvectors().transpose(),
          axes.eigenvectors().col(0), tilt_rad2(axes.eigenvalues())};
}

Relief::Level level_of(const CellMap& coarse) {
  Relief::Level level{coarse.cell_m(), KeyTable(coarse.cells().size()), {}};
  const double floor_m2 = 1e-4 * coarse.cell_m() * coarse.cell_m();
  for (const Cell& cell : coarse.cells()) {
    CellIndex index;
    if (cell.points < kFewPoints || !index_of(cell.mean_m, level.cell_m, index)) continue;
    const auto fresh = static_cast<std::int32_t>(level.surfels.size());
    if (level.table.find_or_add(key_of(index), fresh) != fresh) continue;
    level.surfels.push_back(shaped(cell.mean_m, covariance_m2(cell), [&](const Eigen::Vector3d& v) {
      return Eigen::Vector3d(v.cwiseMax(std::max(kThinnest * v.z(), floor_m2)));
    }));
  }
  return level;
}

}  // namespace

struct Relief::Tree {
  /// As nanoflann wants to be given points.
  struct Means {
    std::vector<std::array<float, 3>> at;
    std::size_t kdtree_get_point_count() const { return at.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return at[i][axis]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Index =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Means>, Means, 3>;

  Means means;
  Index index{3, means, nanoflann::KDTreeSingleIndexAdaptorParams(kInLeaf)};
};

Relief::Relief(const CellMap& map) : cell_m_(map.cell_m()), tree_(std::make_unique<Tree>()) {
  tree_->means.at.reserve(map.cells().size());
  surfels_.reserve(map.cells().size());
  for (const Cell& cell : map.cells()) {
    const Eigen::Vector3f p = cell.mean_m.cast<float>();
    tree_->means.at.push_back({p.x(), p.y(), p.z()});
    surfels_.push_back({cell.mean_m});
  }
  if (!surfels_.empty()) {
    tree_->index.buildIndex();
    fit_surfels(map);
  }
  for (std::size_t i = 0; i < kCoarser.size(); ++i) levels_[i] = level_of(map.coarser(kCoarser[i]));
}

Relief::Relief(Relief&&) noexcept = default;
Relief& Relief::operator=(Relief&&) noexcept = default;
Relief::~Relief() = default;

void Relief::fit_surfels(const CellMap& map) {
  std::array<std::uint32_t, kNeighbours> near{};
  std::array<float, kNeighbours> apart{};
  const Eigen::Vector3d flat =
      Eigen::Vector3d(kAcross * kAcross, kAlong * kAlong, kAlong * kAlong) * cell_m_ * cell_m_;
  const auto flattened = [&](const Eigen::Vector3d&) { return flat; };
  for (std::size_t i = 0; i < surfels_.size(); ++i) {
    if (const Cell& cell = map.cells()[i]; is_a_surface(cell, cell_m_)) {
      surfels_[i] = shaped(surfels_[i].mean_m, covariance_m2(cell), flattened);
      continue;
    }
    const std::size_t found =
        tree_->index.knnSearch(tree_->means.at[i].data(), kNeighbours, near.data(), apart.data());
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < found; ++k) {
      const Eigen::Vector3d d = surfels_[near[k]].mean_m - surfels_[i].mean_m;
      mean += d;
      square.noalias() += d * d.transpose();
    }
    const double part = 1.0 / static_cast<double>(found);
    mean *= part;
    surfels_[i] = shaped(surfels_[i].mean_m, square * part - mean * mean.transpose(), flattened);
  }
}

const Surfel* Relief::nearest(const Eigen::Vector3d& p_m, double reach_m) const noexcept {
  if (surfels_.empty()) return nullptr;
  const Eigen::Vector3f p = p_m.cast<float>();
  std::uint32_t at = 0;
  float square = 0.0F;
  if (tree_->index.knnSearch(p.data(), 1, &at, &square) == 0) return nullptr;
  return square < static_cast<float>(reach_m * reach_m) ? &surfels_[at] : nullptr;
}

const Surfel* Relief::Level::nearest(const Eigen::Vector3d& p_m) const noexcept {
  CellIndex c;
  if (surfels.empty() || !index_of(p_m, cell_m, c)) return nullptr;
  const std::array<CellIndex, 7> around = {{c,
                                            {c.x + 1, c.y, c.z},
                                            {c.x - 1, c.y, c.z},
                                            {c.x, c.y + 1, c.z},
                                            {c.x, c.y - 1, c.z},
                                            {c.x, c.y, c.z + 1},
                                            {c.x, c.y, c.z - 1}}};
  const Surfel* best = nullptr;
  double least = 0.0;
  for (const CellIndex& index : around) {
    const std::int32_t at = table.find(key_of(index));
    if (at < 0) continue;
    const Surfel& s = surfels[static_cast<std::size_t>(at)];
    const double square = (s.mean_m - p_m).squaredNorm();
    if (best == nullptr || square < least) {
      best = &s;
      least = square;
    }
  }
  return best;
}

}  // namespace roverd::nav::cells
