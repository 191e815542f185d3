#pragma once
// Where a robot may drive: areas it must stay in and areas it must stay out of, and the rally
// points to which it can flee. Plain values, and a compiled form in local metres for quick answers.
//
//   ┌──────────────┐ inclusion     A point is allowed if it lies in at least one inclusion area (or
//   │   ╭──╮       │               there is none) and in no exclusion area. Areas may overlap: two
//   │   │×│ ✓  ┌───┼───┐           inclusion areas that touch are one, and the line between them is
//   │   ╰──╯    │ ✓ │ ✓ │           no limit.
//   └──────────┼───┘   │
//              └───────┘
//
// Pure, any thread.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/geo.hpp"
#include "base/result.hpp"

namespace roverd::mission {

enum class AreaKind { Inclusion, Exclusion };

/// Corners in order, either way round; the last one is joined to the first and does not repeat it.
/// The sides are the shortest ways on the ellipsoid.
struct FencePolygon {
  std::vector<base::LatLon> points;
  friend bool operator==(const FencePolygon&, const FencePolygon&) = default;
};
struct FenceCircle {
  base::LatLon center;
  double radius_m = 0.0;
  friend bool operator==(const FenceCircle&, const FenceCircle&) = default;
};
struct FenceArea {
  AreaKind kind = AreaKind::Inclusion;
  std::variant<FencePolygon, FenceCircle> shape;
  friend bool operator==(const FenceArea&, const FenceArea&) = default;
};
struct RallyPoint {
  base::LatLon at;
  std::optional<double> alt_m;
  friend bool operator==(const RallyPoint&, const RallyPoint&) = default;
};
struct Fence {
  std::string name;
  std::vector<FenceArea> areas;
  std::vector<RallyPoint> rally;
  friend bool operator==(const Fence&, const Fence&) = default;
};

inline constexpr std::size_t kMaxAreas = 100;
inline constexpr std::size_t kMaxFencePoints = 10'000;  ///< corners of all polygons together
inline constexpr std::size_t kMaxRally = 100;
inline constexpr double kMaxFenceRadius_m = 10'000.0;
inline constexpr double kMaxFenceSize_m = 20'000.0;  ///< of a polygon, corner to corner

/// Invalid, with JSON pointers ("/areas/0/polygon/3/lat"), unless: the name is one (see json.hpp);
/// there is an area or a rally point; every position and height is in range; polygons have at least
/// three corners, none twice in a row, cover something, do not cross or touch themselves and are at
/// most kMaxFenceSize_m wide; radii are more than 0 and at most kMaxFenceRadius_m. TooLarge beyond
/// the numbers above.
base::Result<void> check_fence(const Fence& fence);

/// A fence laid out in one local frame. Immutable and thread-safe; answers take some microseconds
/// for 10,000 corners and allocate nothing.
///
/// Circles become polygons that differ from them by at most 1 cm, always to the safe side. Exact to
/// 5 cm for areas within 20 km of the frame's origin; areas more than 30 km away count, but no
/// point of the frame is in or near them.
class CompiledFence {
 public:
  /// No fence: everything is allowed.
  CompiledFence() = default;
  /// @param fence satisfies check_fence
  CompiledFence(const Fence& fence, const base::LocalFrame& frame);

  /// Nothing is forbidden anywhere.
  bool empty() const noexcept { return areas_.empty() && !has_inclusion_; }

  /// Whether the point is allowed. Exactly on a limit either may be answered; NaN is not allowed.
  bool contains(base::EnuPoint p) const noexcept;

  /// Distance to the nearest limit between allowed and forbidden, metres: positive where p is
  /// allowed, negative where it is not; +infinity without any limit, −infinity where nothing is
  /// allowed at all, or p is not a number.
  double clearance_m(base::EnuPoint p) const noexcept;

  /// The same for the nearest point of the straight way from a to b; 0 or less (how far the worse
  /// end lies outside) if it is not allowed all along.
  double clearance_m(base::EnuPoint a, base::EnuPoint b) const noexcept;

  /// Metres from a to the first limit that the straight way from a to b meets; empty if it meets
  /// none. It says nothing about whether a is allowed.
  std::optional<double> first_crossing_m(base::EnuPoint a, base::EnuPoint b) const noexcept;

  /// Does the straight way from a to b meet a limit?
  bool crosses(base::EnuPoint a, base::EnuPoint b) const noexcept {
    return first_crossing_m(a, b).has_value();
  }

 private:
  struct Segment {
    base::EnuPoint a;
    base::EnuPoint b;
  };
  struct Box {
    double west_m = std::numeric_limits<double>::infinity();
    double south_m = std::numeric_limits<double>::infinity();
    double east_m = -std::numeric_limits<double>::infinity();
    double north_m = -std::numeric_limits<double>::infinity();
    void take_in(base::EnuPoint p) noexcept;
    bool meets(const Box& other, double margin_m) const noexcept;
    double distance_m(base::EnuPoint p) const noexcept;
  };
  /// Segments in runs of neighbours, each run with its box, so that most of them need no look.
  struct Lines {
    struct Run {
      Box box;
      std::size_t first = 0;
      std::size_t end = 0;
    };
    std::vector<Segment> segments;
    std::vector<Run> runs;
    Box box;
    void close();
    bool encloses(base::EnuPoint p) const noexcept;
    double distance_m(base::EnuPoint p) const noexcept;
  };
  struct Area {
    AreaKind kind = AreaKind::Inclusion;
    Lines ring;
  };

  void find_limits();
  void add_pieces(std::size_t area, const Segment& side);
  void cuts_of(std::size_t area, const Segment& side, std::vector<double>& shares) const;

  std::vector<Area> areas_;
  bool has_inclusion_ = false;
  Lines limits_;  ///< the pieces of sides that part allowed from forbidden
};

}  // namespace roverd::mission
