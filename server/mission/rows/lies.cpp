#include "mission/rows/lies.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"
#include "mission/rows/block.hpp"

namespace roverd::mission {
namespace {

using base::EnuPoint;

constexpr double kShortest_m = 1.0;     // of a row
constexpr double kFarthest_m = 5000.0;  // of a corner from the first one
constexpr double kInside_m = 0.01;      // lanes on the border are cut so far inside of it

/// Of a place: along row 1 from its beginning, and to its right.
struct RowSpot {
  double along_m = 0.0;
  double right_m = 0.0;
};

base::Error wrong_block(std::string pointer, std::string detail) {
  return {base::Code::Invalid, pointer + ' ' + detail, {{pointer, detail}}};
}

class DrawnBlock {
 public:
  explicit DrawnBlock(const std::vector<LatLon>& corners) : plane_(corners.front()) {
    const EnuPoint to = plane_.to_local(corners[1]);
    length_m_ = std::hypot(to.east_m, to.north_m);
    if (length_m_ > 0.0) along_ = {to.east_m / length_m_, to.north_m / length_m_};
    for (const LatLon& corner : corners) spots_.push_back(spot(plane_.to_local(corner)));
  }

  double length_m() const { return length_m_; }
  bool drawn_whole() const { return spots_.size() > 2; }
  double yaw_rad() const { return std::atan2(along_.north_m, along_.east_m); }

  /// Twice the area, positive where it lies to the right of row 1.
  double right_m2() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < spots_.size(); ++i) {
      const RowSpot& a = spots_[i];
      const RowSpot& b = spots_[(i + 1) % spots_.size()];
      sum += a.along_m * b.right_m - b.along_m * a.right_m;
    }
    return sum;
  }

  /// The corners, from the first one.
  std::vector<EnuPoint> border() const {
    std::vector<EnuPoint> out;
    for (const RowSpot& s : spots_) out.push_back({s.along_m, -s.right_m});
    return out;
  }

  struct Lane {
    std::array<LatLon, 2> ends;
    bool parted = false;  ///< it leaves the block on the way, and comes back into it
  };
  /// The lane so far to the right; empty: it does not meet the block. Lanes on its border do.
  std::optional<Lane> lane(double right_m) const {
    if (!drawn_whole()) return Lane{{place({0.0, right_m}), place({length_m_, right_m})}};
    const double inward_m = std::copysign(kInside_m, right_m2());
    const double cut_m = right_m == 0.0 ? inward_m : right_m - inward_m;
    double least_m = 1e300;
    double most_m = -1e300;
    int meets = 0;
    for (std::size_t i = 0; i < spots_.size(); ++i) {
      const RowSpot& a = spots_[i];
      const RowSpot& b = spots_[(i + 1) % spots_.size()];
      if ((a.right_m < cut_m) == (b.right_m < cut_m)) continue;
      const double part = (cut_m - a.right_m) / (b.right_m - a.right_m);
      const double along_m = a.along_m + part * (b.along_m - a.along_m);
      least_m = std::min(least_m, along_m);
      most_m = std::max(most_m, along_m);
      ++meets;
    }
    if (!(most_m - least_m >= kShortest_m)) return std::nullopt;
    return Lane{{place({least_m, right_m}), place({most_m, right_m})}, meets > 2};
  }

 private:
  RowSpot spot(EnuPoint p) const {
    return {p.east_m * along_.east_m + p.north_m * along_.north_m,
            p.east_m * along_.north_m - p.north_m * along_.east_m};
  }
  LatLon place(RowSpot s) const {
    return plane_.to_global({s.along_m * along_.east_m + s.right_m * along_.north_m,
                             s.along_m * along_.north_m - s.right_m * along_.east_m});
  }

  base::TangentPlane plane_;
  EnuPoint along_{1.0, 0.0};
  double length_m_ = 0.0;
  std::vector<RowSpot> spots_;
};

/// On which side of the line from a to b; 0: on it.
double side_of(EnuPoint a, EnuPoint b, EnuPoint p) {
  const EnuPoint ab = b - a;
  const EnuPoint ap = p - a;
  return ab.east_m * ap.north_m - ab.north_m * ap.east_m;
}

bool crosses_itself(const std::vector<EnuPoint>& border) {
  const std::size_t n = border.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = i + 2; k < n; ++k) {
      const EnuPoint a = border[i], b = border[i + 1], c = border[k], d = border[(k + 1) % n];
      if (side_of(a, b, c) * side_of(a, b, d) < 0.0 && side_of(c, d, a) * side_of(c, d, b) < 0.0) {
        return true;
      }
    }
  }
  return false;
}

std::optional<base::Error> wrong_corner(const std::vector<LatLon>& corners) {
  if (corners.size() < 2 || corners.size() > kMostCorners) {
    return wrong_block("/block", "must have from 2 to " + std::to_string(kMostCorners) +
                                     " places: the ends of row 1, or the corners of the block");
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::string at = "/block/" + std::to_string(i);
    if (!base::is_valid(corners[i])) return wrong_block(at, "is no place on earth");
    const double far_m = base::distance_bearing(corners[0], corners[i]).distance_m;
    if (far_m > kFarthest_m) return wrong_block(at, "lies more than 5 km from the first place");
  }
  return std::nullopt;
}

}  // namespace

base::Result<LaidRows> lay_rows(const BlockPlaces& block) {
  if (auto bad = wrong_corner(block.corners)) return tl::unexpected(std::move(*bad));
  const DrawnBlock field(block.corners);
  if (field.length_m() < kShortest_m) {
    return tl::unexpected(wrong_block("/block/1",
                                      "lies less than 1 m from the first place: row 1 leads "
                                      "from one to the other"));
  }
  const bool whole = field.drawn_whole();
  if (!whole && !block.rows) return tl::unexpected(wrong_block("/rows", "is required"));
  if (whole && crosses_itself(field.border())) {
    return tl::unexpected(wrong_block("/block", "crosses itself"));
  }
  const Side inside = field.right_m2() < 0.0 ? Side::Left : Side::Right;
  LaidRows out;
  out.turn = block.turn.value_or(inside);
  if (whole && out.turn != inside) {
    return tl::unexpected(wrong_block("/turn", std::string("must be ") +
                                                   (inside == Side::Left ? "left" : "right") +
                                                   ": there the block lies, seen along row 1"));
  }
  // 360 less a rounding error is 0.
  out.heading_deg =
      std::fmod(std::round(base::heading_from_yaw(field.yaw_rad()) * 1e4) / 1e4, 360.0);
  const double side = out.turn == Side::Right ? 1.0 : -1.0;
  const int most = block.rows.value_or(kMostRows);
  for (int k = 0; k < most; ++k) {
    const auto lane = field.lane(side * k * block.spacing_m);
    if (lane && lane->parted) {
      return tl::unexpected(wrong_block("/block", "is left and entered again by row " +
                                                      std::to_string(k + 1) +
                                                      ": draw it as several blocks"));
    }
    if (lane) {
      out.lanes.push_back(lane->ends);
      continue;
    }
    if (!block.rows && k > 0) return out;
    return tl::unexpected(wrong_block(
        k > 0 ? "/rows" : "/block",
        k > 0 ? "asks for row " + std::to_string(k + 1) + ", which lies outside of the block"
              : "has no room for row 1 between its first two places"));
  }
  return out;
}

}  // namespace roverd::mission
