// Operations that take waypoints out of a way or put some in: simplify, densify.

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/tangent_plane.hpp"
#include "mission/edit/operation_steps.hpp"
#include "mission/json/json.hpp"

namespace roverd::mission {

using base::EnuPoint;
using base::Error;
using base::Result;
using base::TangentPlane;

namespace {

double distance_to_segment_m(EnuPoint p, EnuPoint a, EnuPoint b) noexcept {
  const EnuPoint ab = b - a;
  const EnuPoint ap = p - a;
  const double square = ab.east_m * ab.east_m + ab.north_m * ab.north_m;
  const double along =
      square > 0.0
          ? std::clamp((ap.east_m * ab.east_m + ap.north_m * ab.north_m) / square, 0.0, 1.0)
          : 0.0;
  return std::hypot(ap.east_m - along * ab.east_m, ap.north_m - along * ab.north_m);
}

/// Ramer-Douglas-Peucker over one run of points.
/// Source: Ramer 1972; Douglas and Peucker 1973 (distance to the segment, not to its line).
class Thinner {
 public:
  Thinner(const std::vector<EnuPoint>& points, double tolerance_m)
      : points_(points), tolerance_m_(tolerance_m), keep_(points.size(), false) {
    // Ways that would take the square of their length are halved where they stand from here on:
    // that keeps a few points too many, never one too few.
    constexpr std::size_t kPerPoint = 200;
    budget_ = kPerPoint * points.size();
  }

  /// @return by index, whether a point stays; the ends do.
  std::vector<bool> run() {
    if (points_.empty()) return keep_;
    keep_.front() = keep_.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> todo{{0, points_.size() - 1}};
    while (!todo.empty()) {
      const auto [first, last] = todo.back();
      todo.pop_back();
      if (last - first < 2) continue;
      const std::size_t at = farthest(first, last);
      if (at == first) continue;
      keep_[at] = true;
      todo.emplace_back(first, at);
      todo.emplace_back(at, last);
    }
    return keep_;
  }

 private:
  /// `first` if all of them are near enough.
  std::size_t farthest(std::size_t first, std::size_t last) {
    std::size_t at = first;
    double most_m = tolerance_m_;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double far_m = distance_to_segment_m(points_[i], points_[first], points_[last]);
      if (far_m > most_m) {
        most_m = far_m;
        at = i;
      }
    }
    const std::size_t cost = last - first;
    const bool spent = budget_ < cost;
    budget_ -= spent ? budget_ : cost;
    return spent && at != first ? (first + last) / 2 : at;
  }

  const std::vector<EnuPoint>& points_;
  const double tolerance_m_;
  std::vector<bool> keep_;
  std::size_t budget_ = 0;
};

/// Can it go without changing how the next one is driven to?
bool is_plain(const Waypoint& point, const Waypoint& next) {
  return point.hold_s.value_or(0.0) == 0.0 && point.speed_mps == next.speed_mps &&
         point.reverse == next.reverse && point.turn == next.turn &&
         point.radius_m == next.radius_m;
}

const Waypoint* waypoint_at(const Plan& plan, std::size_t i) {
  return i < plan.items.size() ? std::get_if<Waypoint>(&plan.items[i]) : nullptr;
}

/// Marks what goes of the run [first, last] of waypoints.
void thin(const Plan& plan, std::size_t first, std::size_t last, double tolerance_m,
          std::vector<bool>& gone) {
  if (last - first < 2) return;
  const TangentPlane plane(waypoint_at(plan, first)->at);
  std::vector<EnuPoint> points;
  points.reserve(last - first + 1);
  for (std::size_t i = first; i <= last; ++i) {
    points.push_back(plane.to_local(waypoint_at(plan, i)->at));
  }
  const auto keep = Thinner(points, tolerance_m).run();
  for (std::size_t i = first; i <= last; ++i) gone[i] = !keep[i - first];
}

/// Ends a leg's way somewhere else than where the waypoint before it stands.
bool moves_otherwise(const Item& item) {
  return std::holds_alternative<Local>(item) || std::holds_alternative<Move>(item) ||
         std::holds_alternative<Row>(item) || std::holds_alternative<Wall>(item) ||
         std::holds_alternative<Landmarks>(item) || std::holds_alternative<Dock>(item) ||
         std::holds_alternative<Jump>(item) || std::holds_alternative<ReturnHome>(item) ||
         std::holds_alternative<Action>(item) || std::holds_alternative<Loiter>(item) ||
         std::holds_alternative<Circle>(item) || std::holds_alternative<MapPoint>(item);
}

/// How many pieces of at most `at_most_m` a leg has; a micrometre too long is no reason for one
/// more.
std::size_t pieces_of(double leg_m, double at_most_m) {
  constexpr double kGrace_m = 1e-6;
  const double pieces = std::ceil((leg_m - kGrace_m) / at_most_m);
  return pieces < 1.0 ? 1 : static_cast<std::size_t>(std::min(pieces, 1e9));
}

/// Waypoints laid out one after the other, with one plane for the legs of a neighbourhood: to make
/// one costs more than a leg.
class Layout {
 public:
  /// Where `at` lies in a plane that touches the earth at most 500 m from `from`, and `from` in the
  /// same plane. Asked for leg after leg: the end of the last one is known.
  void lay_out(LatLon from, LatLon to) {
    constexpr double kNear_m = 500.0;
    const bool follows = plane_ && from == last_;
    begin_ = follows ? end_ : EnuPoint{2.0 * kNear_m, 0.0};
    if (begin_.east_m * begin_.east_m + begin_.north_m * begin_.north_m > kNear_m * kNear_m) {
      plane_.emplace(from);
      begin_ = {};
    }
    end_ = plane_->to_local(to);
    last_ = to;
  }

  /// The end of the last leg is not where the plane says.
  void forget() noexcept { plane_.reset(); }

  EnuPoint begin() const noexcept { return begin_; }
  EnuPoint end() const noexcept { return end_; }
  LatLon to_global(EnuPoint p) const noexcept { return plane_->to_global(p); }

 private:
  std::optional<TangentPlane> plane_;
  LatLon last_;
  EnuPoint begin_;
  EnuPoint end_;
};

/// The way from one waypoint to the next.
class Leg {
 public:
  Leg(const Waypoint& from, const Waypoint& to, Layout& layout)
      : from_(from), to_(to), layout_(layout) {
    layout.lay_out(from.at, to.at);
    way_m_ = layout.end() - layout.begin();
    length_m_ = std::sqrt(way_m_.east_m * way_m_.east_m + way_m_.north_m * way_m_.north_m);
    // Far away the plane is not exact any more, and behind the horizon it is wrong.
    constexpr double kNear_m = 500.0;  // with the plane's 500 m: 4 µm
    constexpr double kNear_deg = 0.5;
    const double dlon = std::abs(to.at.lon - from.at.lon);
    const bool near = length_m_ < kNear_m && std::abs(to.at.lat - from.at.lat) < kNear_deg &&
                      (dlon < 90.0 || dlon > 270.0);
    if (!near) {
      layout.forget();
      way_ = base::distance_bearing(from.at, to.at);
      length_m_ = way_.distance_m;
      by_ = By::Geodesic;
    } else if (length_m_ < kShort_m && std::abs(to.at.lat) < kNotPolar_deg && dlon < 1.0) {
      by_ = By::Degrees;
    }
  }

  double length_m() const noexcept { return length_m_; }

  /// Points between the two, for `pieces` equal pieces.
  void divide(std::size_t pieces, std::vector<Item>& out) const {
    for (std::size_t k = 1; k < pieces; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(pieces);
      auto& between = std::get<Waypoint>(out.emplace_back(std::in_place_type<Waypoint>));
      between.at = at(share);
      if (from_.alt_m && to_.alt_m) {
        between.alt_m = *from_.alt_m + share * (*to_.alt_m - *from_.alt_m);
      }
      between.speed_mps = to_.speed_mps;
      between.radius_m = to_.radius_m;
      between.reverse = to_.reverse;
      between.turn = to_.turn;
    }
  }

 private:
  /// Equal steps of latitude and longitude leave the straight way by d² tan(lat) / 8R at most:
  /// 0.03 mm for 20 m at 75°. They cost a tenth of the way through the plane.
  enum class By { Degrees, Plane, Geodesic };
  static constexpr double kShort_m = 20.0;
  static constexpr double kNotPolar_deg = 75.0;

  LatLon at(double share) const noexcept {
    switch (by_) {
      case By::Degrees:
        return {from_.at.lat + share * (to_.at.lat - from_.at.lat),
                from_.at.lon + share * (to_.at.lon - from_.at.lon)};
      case By::Plane:
        return layout_.to_global(layout_.begin() +
                                 EnuPoint{way_m_.east_m * share, way_m_.north_m * share});
      case By::Geodesic:
        break;
    }
    return base::destination(from_.at, way_.bearing_deg, length_m_ * share);
  }

  const Waypoint& from_;
  const Waypoint& to_;
  const Layout& layout_;
  EnuPoint way_m_;
  base::DistanceBearing way_;
  double length_m_ = 0.0;
  By by_ = By::Plane;
};

}  // namespace

Result<Done> apply(Plan plan, const Simplify& simplify) {
  if (!(simplify.tolerance_m > 0.0 && simplify.tolerance_m <= kMaxTolerance_m)) {
    return tl::unexpected<Error>(wrong("/tolerance_m", "must be more than 0 and at most 1000"));
  }
  const auto which = numbers_in(plan, simplify.which);
  if (!which) return tl::unexpected<Error>(which.error());
  const auto end = static_cast<std::size_t>(which->last);
  const auto targets = jump_targets(plan);
  std::vector<bool> gone(plan.items.size(), false);
  std::size_t first = static_cast<std::size_t>(which->first) - 1;
  for (std::size_t i = first; i < end; ++i) {
    const Waypoint* point = waypoint_at(plan, i);
    if (point == nullptr) {
      first = i + 1;
      continue;
    }
    const Waypoint* next = i + 1 < end ? waypoint_at(plan, i + 1) : nullptr;
    if (next != nullptr && i != first && !targets[i] && is_plain(*point, *next)) continue;
    thin(plan, first, i, simplify.tolerance_m, gone);
    first = i;
  }
  const auto count = static_cast<std::size_t>(std::count(gone.begin(), gone.end(), true));
  std::string what = "simplified " + words_of(plan, *which) + " within " +
                     rounded_text(simplify.tolerance_m) + " m: " + counted(count, "waypoint") +
                     " less";
  take_out(plan.items, std::move(gone));
  return Done{std::move(plan), std::move(what), std::nullopt, {}};
}

Result<Done> apply(Plan plan, const Densify& densify) {
  constexpr double kMin_m = 0.01;
  constexpr double kMax_m = 100'000.0;
  if (!(densify.at_most_m >= kMin_m && densify.at_most_m <= kMax_m)) {
    return tl::unexpected<Error>(wrong("/at_most_m", "must be from 0.01 to 100000"));
  }
  const auto which = numbers_in(plan, densify.which);
  if (!which) return tl::unexpected<Error>(which.error());
  std::string words = words_of(plan, *which);
  std::vector<int> new_number(plan.items.size());
  std::vector<Item> items;
  items.reserve(std::min(2 * plan.items.size() + 16, kMaxItems + 1));
  std::optional<Waypoint> before;
  Layout layout;
  std::size_t added = 0;
  for (std::size_t i = 0; i < plan.items.size(); ++i) {
    const int number = static_cast<int>(i) + 1;
    const bool inside = number >= which->first && number <= which->last;
    const Waypoint* point = waypoint_at(plan, i);
    if (point != nullptr && before && inside) {
      const Leg leg(*before, *point, layout);
      const std::size_t pieces = pieces_of(leg.length_m(), densify.at_most_m);
      if (items.size() + pieces + (plan.items.size() - i) > kMaxItems + 1) {
        return tl::unexpected<Error>(wrong(
            "/at_most_m",
            "is too small: more than " + std::to_string(kMaxItems) + " items would be needed"));
      }
      leg.divide(pieces, items);
      added += pieces - 1;
    }
    if (point != nullptr) before = inside ? std::optional(*point) : std::nullopt;
    if (moves_otherwise(plan.items[i])) before.reset();
    new_number[i] = static_cast<int>(items.size()) + 1;
    items.push_back(std::move(plan.items[i]));
  }
  plan.items = std::move(items);
  lead_jumps(plan.items, new_number);
  return Done{std::move(plan),
              "densified " + words + " to " + rounded_text(densify.at_most_m) +
                  " m: " + counted(added, "waypoint") + " more",
              std::nullopt,
              {}};
}

}  // namespace roverd::mission
