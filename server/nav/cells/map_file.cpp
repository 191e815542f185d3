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

Cell cell_at(std::span<const float> values) {
  Cell cell;
  cell.mean_m = {values[0], values[1], values[2]};
  cell.points = values[3];
  for (std::size_t k = 0; k < 6; ++k) cell.spread_m2[k] = double{values[4 + k]} * cell.points;
  return cell;
}

Cell point_at(std::span<const float> values) {
  Cell cell;
  cell.mean_m = {values[0], values[1], values[2]};
  cell.points = 1.0;
  return cell;
}

/// No sensor fills a cube so, and what is more is none of a file: sums of them are infinite.
bool can_be(const Cell& cell) {
  constexpr double kMostPoints = 1e15;
  constexpr double kMostSpread_m2 = 1e6;  // of one point; the largest cell has an edge of 100 m
  return finite(cell) && cell.points <= kMostPoints &&
         std::ranges::all_of(cell.spread_m2, [&](double sum) {
           return std::abs(sum) <= kMostSpread_m2 * cell.points;
         });
}

std::string count_of(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + (n == 1 ? one : many);
}

/// One of the points that lie too far away, and how far they may.
std::string example_of(const Eigen::Vector3d& far, double cell_m) {
  const auto metres = [](double m) { return std::to_string(std::lround(m)); };
  return "(one at x " + metres(far.x()) + ", y " + metres(far.y()) + ", z " + metres(far.z()) +
         " m; the cells reach " + metres(reach_m(cell_m) / 1000.0) +
         " km): take a corner of the site off all of them";
}

/// Why a map is none though its file could be read; empty: it is one.
std::string why_none(const ReadMap& read, const Eigen::Vector3d& far) {
  if (read.points == read.no_number) return "not one point of the file is a number";
  const std::size_t numbers = read.points - read.no_number;
  if (read.too_far * 100 <= numbers && !read.map.cells().empty()) return {};
  const std::string which = read.too_far == numbers ? "all points lie"
                                                    : std::to_string(read.too_far) + " of " +
                                                          std::to_string(numbers) + " points lie";
  return which + " too far from the origin " + example_of(far, read.map.cell_m());
}

}  // namespace

std::vector<std::uint8_t> write_map(const CellMap& map) {
  const auto& cells = map.cells();
  return write_packed_pcd(
      kColumns, static_cast<std::uint32_t>(cells.size()),
      [&cells](std::size_t column, std::size_t i) {
        const Cell& c = cells[i];
        if (column < 3) {
          return static_cast<float>(c.mean_m[static_cast<Eigen::Index>(column)]);
        }
        if (column == 3) return static_cast<float>(c.points);
        return static_cast<float>(c.spread_m2[column - 4] / c.points);
      });
}

base::Result<ReadMap> read_whole_map(base::Bytes file, double cell_m, std::size_t most_cells) {
  auto reader = PcdReader::open(file, kColumns);
  const bool cells = reader.has_value();
  if (!cells) reader = PcdReader::open(file, kPcdXyz);
  if (!reader) return tl::unexpected<base::Error>(reader.error());
  ReadMap out(cell_m);
  constexpr std::array<double, 7> kUnmoved = {0, 0, 0, 1, 0, 0, 0};
  out.viewpoint = reader->viewpoint() != kUnmoved;
  out.map.expect(std::min(reader->points(), most_cells + 1));
  Eigen::Vector3d far = Eigen::Vector3d::Zero();
  bool full = false;
  const auto read = reader->read([&](std::span<const float> values) {
    const Cell cell = cells ? cell_at(values) : point_at(values);
    ++out.points;
    if (CellIndex at; cell.mean_m.allFinite() && !index_of(cell.mean_m, out.map.cell_m(), at)) {
      if (out.too_far++ == 0) far = cell.mean_m;
    } else if (!can_be(cell)) {
      ++out.no_number;
    } else {
      full = !out.map.add(cell) || out.map.cells().size() > most_cells;
    }
    return !full;
  });
  if (!read) return tl::unexpected<base::Error>(read.error());
  if (full) {
    return base::fail(base::Code::TooLarge,
                      "there is more in it than " + std::to_string(most_cells) +
                          " cells can hold, each with an edge of " +
                          std::to_string(std::lround(out.map.cell_m() * 100.0)) +
                          " cm: cut it to where the robot drives");
  }
  if (const std::string why = why_none(out, far); !why.empty()) {
    return base::fail(base::Code::Invalid, why);
  }
  return out;
}

base::Result<CellMap> read_map(base::Bytes file, double cell_m) {
  auto read = read_whole_map(file, cell_m);
  if (!read) return tl::unexpected<base::Error>(read.error());
  return std::move(read->map);
}

std::vector<std::string> left_out(const ReadMap& read) {
  std::vector<std::string> out;
  if (read.no_number > 0) {
    out.push_back(
        count_of(read.no_number, " point that is no number", " points that are no numbers"));
  }
  if (read.too_far > 0) {
    out.push_back(count_of(read.too_far, " point too far from the origin",
                           " points too far from the origin"));
  }
  if (read.viewpoint) out.emplace_back("VIEWPOINT: the points are taken as they stand");
  return out;
}

}  // namespace roverd::nav::cells
