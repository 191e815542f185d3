#include "nav/cells/map_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "nav/cells/pcd.hpp"

namespace roverd::nav::cells {

namespace {

constexpr std::array<std::string_view, 10> kColumns = {"x",  "y",  "z",  "points", "xx",
                                                       "xy", "xz", "yy", "yz",     "zz"};

Cell cell_at(const PcdTable& t, std::size_t i) {
  const auto value = [&](std::size_t column) { return double{t.columns[column][i]}; };
  Cell cell;
  cell.mean_m = {value(0), value(1), value(2)};
  cell.points = value(3);
  for (std::size_t k = 0; k < 6; ++k) cell.spread_m2[k] = value(4 + k) * cell.points;
  return cell;
}

}  // namespace

base::Result<std::vector<std::uint8_t>> write_map(const CellMap& map) {
  PcdTable t;
  t.width = static_cast<std::uint32_t>(map.cells().size());
  t.names.assign(kColumns.begin(), kColumns.end());
  t.columns.resize(kColumns.size());
  for (const Cell& cell : map.cells()) {
    for (std::size_t k = 0; k < 3; ++k) {
      t.columns[k].push_back(static_cast<float>(cell.mean_m[static_cast<Eigen::Index>(k)]));
    }
    t.columns[3].push_back(static_cast<float>(cell.points));
    for (std::size_t k = 0; k < 6; ++k) {
      t.columns[4 + k].push_back(static_cast<float>(cell.spread_m2[k] / cell.points));
    }
  }
  return write_pcd(t, PcdData::Compressed);
}

namespace {

/// Why nothing was taken of it. @param cloud at least one point that is taken nowhere, or none
std::string why_empty(std::span<const Eigen::Vector3f> cloud, double cell_m) {
  const auto far = std::find_if(cloud.begin(), cloud.end(),
                                [](const Eigen::Vector3f& p) { return p.allFinite(); });
  if (far == cloud.end()) return "not one point of the file is a number";
  const auto metres = [](float m) { return std::to_string(std::lround(m)); };
  return "all points lie too far from the origin (one at x " + metres(far->x()) + ", y " +
         metres(far->y()) + ", z " + metres(far->z()) + " m; the cells reach " +
         std::to_string(std::lround(reach_m(cell_m) / 1000.0)) +
         " km): take a corner of the site off all of them";
}

}  // namespace

base::Result<CellMap> read_map(base::Bytes file, double cell_m) {
  CellMap map(cell_m);
  std::vector<Eigen::Vector3f> points;
  if (const auto table = read_pcd(file, kColumns)) {
    for (std::size_t i = 0; i < table->columns[0].size(); ++i) map.add(cell_at(*table, i));
  } else {
    auto cloud = read_pcd_cloud(file);
    if (!cloud) return tl::unexpected<base::Error>(cloud.error());
    map.add(*cloud);
    points = std::move(*cloud);
  }
  if (map.cells().empty()) {
    return base::fail(base::Code::Invalid, why_empty(points, map.cell_m()));
  }
  return map;
}

}  // namespace roverd::nav::cells
