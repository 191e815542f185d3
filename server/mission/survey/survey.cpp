#include "mission/survey/survey.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "mission/json/pointer.hpp"
#include "mission/survey/cells.hpp"
#include "mission/survey/cover.hpp"
#include "mission/survey/direction.hpp"
#include "mission/survey/drawer.hpp"
#include "mission/survey/field.hpp"
#include "mission/text.hpp"

namespace roverd::mission {
namespace survey {
namespace {

using base::Error;
using base::Result;

tl::unexpected<Error> refuse(const char* pointer, std::string detail) {
  Problems problems;
  problems.add(pointer, std::move(detail));
  return tl::unexpected<Error>(std::move(problems).error("the survey"));
}

/// "12 m²"
std::string square_text(double m2) {
  return number_text(m2 < 10.0 ? std::round(m2 * 10.0) / 10.0 : std::round(m2)) + " m²";
}

/// Where the path bends more within its pieces than an arc of the radius would.
int tight_turns(const std::vector<PathPoint>& path, double radius_m) {
  constexpr double kGrace = 1.3;  // chords are shorter than their arcs, and rounded to 0.1 mm
  constexpr double kGrace_rad = 0.05;
  constexpr double kChord_rad = 0.7;  // no chord of an arc spans more
  const double most_m = kChord_rad * radius_m;
  int count = 0;
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const EnuPoint a = path[i].at - path[i - 1].at;
    const EnuPoint b = path[i + 1].at - path[i].at;
    double turn = std::abs(
        base::angle_diff_rad(std::atan2(a.north_m, a.east_m), std::atan2(b.north_m, b.east_m)));
    if (path[i].reverse != path[i + 1].reverse) turn = base::kPi - turn;
    const double chord_m = 0.5 * (std::min(most_m, std::hypot(a.east_m, a.north_m)) +
                                  std::min(most_m, std::hypot(b.east_m, b.north_m)));
    if (turn > kGrace * chord_m / radius_m + kGrace_rad) ++count;
  }
  return count;
}

/// The numbers, each in its range.
Result<void> check(const SurveyRequest& r) {
  Problems problems;
  const auto want = [&problems](const char* pointer, double value, double low, double high) {
    if (value >= low && value <= high) return;
    problems.add(pointer, "must be from " + number_text(low) + " to " + number_text(high));
  };
  want("/spacing_m", r.spacing_m, 0.05, 1000.0);
  if (r.direction_deg) want("/direction_deg", *r.direction_deg, -360.0, 360.0);
  if (r.turn == SurveyTurn::Arc) want("/radius_m", r.radius_m, 0.1, 100.0);
  want("/headland_passes", r.headland_passes, r.pattern == SurveyPattern::Perimeter ? 1 : 0, 100);
  if (r.border_m) want("/border_m", *r.border_m, 0.0, 1000.0);
  want("/overshoot_m", r.overshoot_m, 0.0, 100.0);
  want("/skip", r.skip, 0, 50);
  if (const auto* at = std::get_if<LatLon>(&r.start); at != nullptr && !base::is_valid(*at)) {
    problems.add("/start", "is not a position on earth");
  }
  if (problems.none()) return {};
  return tl::unexpected<Error>(std::move(problems).error("the survey"));
}

class Planner {
 public:
  Planner(const SurveyRequest& request, Field field)
      : request_(request),
        field_(std::move(field)),
        spacing_m_(request.spacing_m),
        border_m_(request.border_m.value_or(request.spacing_m / 2.0)),
        // A swath's round end leaves the tip of a corner open: in a spiral, where every ring has
        // corners, a share of 0.05 of the spacing's square for each right angle, and 0.01 so.
        ring_step_m_(request.spacing_m * (request.pattern == SurveyPattern::Spiral ? 0.92 : 1.0)),
        sagitta_m_(std::clamp(request.spacing_m / 100.0, 0.001, 0.025)) {}

  Result<Survey> plan() {
    if (auto fine = find_part(); !fine) return tl::unexpected<Error>(fine.error());
    out_.field_m2 = square_m2(field_.area);
    const double slack_m = std::min(std::max(border_m_ / 2.0, 0.002), 2.0 * sagitta_m_);
    const Ways ways(part_, slack_m, sagitta_m_ / 4.0);
    Drawer drawer(ways, {request_.turn, request_.radius_m, sagitta_m_});
    start_ = start_point();
    const int rings =
        request_.pattern == SurveyPattern::Spiral ? kAllRings : request_.headland_passes;
    draw_rings(rings, drawer);
    if (auto fine = draw_tracks(drawer, ways); !fine) return tl::unexpected<Error>(fine.error());
    if (drawer.points().size() > kMaxSurveyItems) return too_many();
    if (drawer.points().empty()) return refuse("/headland_passes", "0 leaves nothing to drive");
    finish(drawer);
    return std::move(out_);
  }

 private:
  static constexpr int kAllRings = 1'000'000;

  tl::unexpected<Error> too_many() const {
    return refuse("/spacing_m", "is too small for this field: more than " +
                                    std::to_string(kMaxSurveyItems) + " items would be needed");
  }

  /// What can be driven without coming too near to the border: one connected piece of it.
  Result<void> find_part() {
    auto parts =
        parts_of(border_m_ > 0.0 ? offset(field_.area, -border_m_, sagitta_m_) : field_.area);
    if (parts.empty()) {
      const bool given = request_.border_m.has_value();
      return refuse(given ? "/border_m" : "/spacing_m", "is larger than the field: no place is " +
                                                            number_text(border_m_) +
                                                            " m away from its border");
    }
    std::size_t chosen = 0;  // the largest
    if (const auto* at = std::get_if<LatLon>(&request_.start)) chosen = part_at(parts, *at);
    part_ = std::move(parts[chosen]);
    double rest_m2 = 0.0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (i != chosen) rest_m2 += square_m2(parts[i].area());
    }
    if (parts.size() > 1) {
      out_.notes.push_back(std::to_string(parts.size() - 1) + " more parts of together " +
                           square_text(rest_m2) +
                           " lie behind places that are too narrow to pass, and are left out: make "
                           "border_m smaller, or start there");
    }
    return {};
  }

  std::size_t part_at(const std::vector<Part>& parts, LatLon at) const {
    const EnuPoint p = field_.plane.to_local(at);
    std::size_t best = 0;
    double best_m2 = -1.0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      for (const auto& edge : edges_of({parts[i].outer})) {
        const double square = square_from_edge(p, edge);
        if (best_m2 >= 0.0 && square >= best_m2) continue;
        best_m2 = square;
        best = i;
      }
    }
    return best;
  }

  EnuPoint start_point() const {
    if (const auto* at = std::get_if<LatLon>(&request_.start)) return field_.plane.to_local(*at);
    const Box box = box_of(part_.area());
    const FieldCorner corner = std::get<FieldCorner>(request_.start);
    const bool east = corner == FieldCorner::SouthEast || corner == FieldCorner::NorthEast;
    const bool north = corner == FieldCorner::NorthWest || corner == FieldCorner::NorthEast;
    return {east ? box.high.east_m : box.low.east_m, north ? box.high.north_m : box.low.north_m};
  }

  /// Corners that a vehicle can drive round; as it is where too much would be lost by that.
  Area drivable_rings(const Area& level) const {
    if (request_.turn == SurveyTurn::Pivot) return level;
    const double r = request_.radius_m;
    Area rounded = offset(offset(level, -r, sagitta_m_), r, sagitta_m_);
    if (rings_ > 0 && !rounded.empty()) return rounded;  // tracks cover what it leaves open
    const double grace_m = 0.01 * spacing_m_;
    const auto lost = parts_of(without(level, offset(rounded, grace_m, sagitta_m_)));
    const bool much = !lost.empty() && square_m2(lost.front().area()) > least_open_m2();
    return rounded.empty() || much ? level : rounded;
  }

  /// Smaller spots in corners are not worth a turn.
  double least_open_m2() const {
    const double corner_m2 = 0.1 * spacing_m_ * spacing_m_;
    const bool arcs = request_.turn == SurveyTurn::Arc;
    return arcs ? std::max(corner_m2, request_.radius_m * request_.radius_m) : corner_m2;
  }

  /// How far inside of the first ring the last one covers.
  double covered_m() const { return (rings_ - 1) * ring_step_m_ + spacing_m_ / 2.0; }

  /// Ring k runs k steps inside of the first. What rings leave open in sharp corners and at the
  /// ends of ridges, and what lies inside of the last one, is left for tracks.
  ///
  ///      ╲ ring k−1     ring k turns back before the corner
  ///     ▒▒╲             of what ring k−1 left: ▒ stays open
  ///   ╲╱ k
  void draw_rings(int count, Drawer& drawer) {
    std::vector<Level> levels;
    std::size_t points = 0;
    Area level = part_.area();
    while (rings_ < count && points <= kMaxSurveyItems) {
      levels.push_back({parts_of(drivable_rings(level)), {}});
      for (const Part& part : levels.back().parts) points += part.outer.size();
      Area next = offset(part_.area(), -ring_step_m_ * ++rings_, sagitta_m_);
      if (rings_ == count || next.empty()) break;
      leave_open(next);
      level = std::move(next);
    }
    draw_nested(levels, drawer);
    if (request_.pattern == SurveyPattern::Perimeter) {
      open_.clear();
      return;
    }
    const Area inner = rings_ == 0 ? part_.area() : offset(part_.area(), -covered_m(), sagitta_m_);
    open_.insert(open_.end(), inner.begin(), inner.end());
  }

  /// What neither the last ring nor the next one covers.
  void leave_open(const Area& next) {
    const double grace_m = 0.01 * spacing_m_;
    const Area due = offset(part_.area(), -covered_m(), sagitta_m_);
    const Area done = offset(drivable_rings(next), spacing_m_ / 2.0 + grace_m, sagitta_m_);
    for (const Part& part : parts_of(without(due, done))) {
      if (square_m2(part.area()) < least_open_m2()) continue;
      const Area area = part.area();
      open_.insert(open_.end(), area.begin(), area.end());
    }
  }

  /// The rings that lie equally deep.
  struct Level {
    std::vector<Part> parts;
    std::vector<bool> taken;
  };

  /// A part, and then what lies inside of it, before another part of the same depth: arms of a
  /// field are done one after the other.
  void draw_nested(std::vector<Level>& levels, Drawer& drawer) {
    struct Place {
      std::size_t level;
      std::size_t part;
    };
    for (Level& level : levels) level.taken.resize(level.parts.size(), false);
    std::vector<Place> todo;
    for (std::size_t k = 0; k < levels.size(); ++k) {
      for (std::size_t i = 0; i < levels[k].parts.size(); ++i) {
        if (levels[k].taken[i]) continue;
        levels[k].taken[i] = true;
        todo.push_back({k, i});
        while (!todo.empty() && drawer.points().size() <= kMaxSurveyItems) {
          const Place at = todo.back();
          todo.pop_back();
          const Part& outer = levels[at.level].parts[at.part];
          draw_part(outer, drawer);
          if (at.level + 1 == levels.size()) continue;
          Level& inner = levels[at.level + 1];
          for (std::size_t j = inner.parts.size(); j-- > 0;) {
            if (inner.taken[j] || !holds(outer.outer, inner.parts[j].outer.front())) continue;
            inner.taken[j] = true;
            todo.push_back({at.level + 1, j});
          }
        }
      }
    }
  }

  static bool holds(const Ring& ring, EnuPoint p) {
    bool in = false;
    for (const auto& e : edges_of({ring})) {
      if ((e.a.north_m > p.north_m) == (e.b.north_m > p.north_m)) continue;
      const double share = (p.north_m - e.a.north_m) / (e.b.north_m - e.a.north_m);
      if (p.east_m < e.a.east_m + share * (e.b.east_m - e.a.east_m)) in = !in;
    }
    return in;
  }

  static double square_from_m2(EnuPoint p, const Ring& ring) {
    double best = square_from_edge(p, {ring.front(), ring.front()});
    for (const auto& edge : edges_of({ring})) best = std::min(best, square_from_edge(p, edge));
    return best;
  }

  /// Its rings, the nearest one first.
  void draw_part(const Part& part, Drawer& drawer) {
    std::vector<Ring> rings = part.area();
    while (!rings.empty() && drawer.points().size() <= kMaxSurveyItems) {
      const EnuPoint at = drawer.at().value_or(start_);
      const auto next =
          std::min_element(rings.begin(), rings.end(), [at](const Ring& a, const Ring& b) {
            return square_from_m2(at, a) < square_from_m2(at, b);
          });
      drawer.round(simplified(*next, sagitta_m_), start_);
      rings.erase(next);
    }
  }

  Result<void> draw_tracks(Drawer& drawer, const Ways& ways) {
    const bool whole = request_.pattern == SurveyPattern::Tracks;
    const double heading_deg =
        request_.direction_deg
            ? *request_.direction_deg
            : best_direction_deg(open_.empty() ? part_.area() : open_, spacing_m_);
    out_.direction_deg = base::heading_from_yaw(base::yaw_from_heading(heading_deg));
    if (open_.empty()) return {};
    const Rotation turned(base::yaw_from_heading(heading_deg));
    const Area area = turned.forth(open_);
    const bool inner = whole && request_.headland_passes == 0;
    const Box box = box_of(area);
    if ((box.high.north_m - box.low.north_m) / spacing_m_ > double(kMaxSurveyItems)) {
      return too_many();
    }
    const auto cells = inner ? inner_cells(area, spacing_m_) : covering_cells(area, spacing_m_);
    if (cells.empty()) return too_many();
    std::size_t tracks = 0;
    for (const Cell& cell : cells) tracks += cell.size();
    out_.cells = static_cast<int>(cells.size());
    out_.tracks = static_cast<int>(tracks);
    if (2 * tracks > kMaxSurveyItems) return too_many();
    const EnuPoint from = turned.forth(drawer.at().value_or(start_));
    for (const Drive& drive : drives_from(from, cells, request_.skip)) {
      const EnuPoint begin = turned.back(drive.begin);
      const EnuPoint end = turned.back(drive.end);
      drawer.line(lengthened(end, begin, ways), lengthened(begin, end, ways));
      if (drawer.points().size() > kMaxSurveyItems) return too_many();
    }
    return {};
  }

  /// `to`, moved on by the overshoot as far as there is room.
  EnuPoint lengthened(EnuPoint from, EnuPoint to, const Ways& ways) const {
    const double length_m = base::distance_m(from, to);
    if (request_.overshoot_m <= 0.0 || length_m <= 0.0) return to;
    const double share = request_.overshoot_m / length_m;
    const EnuPoint more{(to.east_m - from.east_m) * share, (to.north_m - from.north_m) * share};
    const double room = ways.share_clear(to, to + more);
    return {to.east_m + more.east_m * room, to.north_m + more.north_m * room};
  }

  void finish(const Drawer& drawer) {
    std::vector<EnuPoint> path;
    out_.items.reserve(drawer.points().size());
    for (const PathPoint& p : drawer.points()) {
      Waypoint w;
      w.at = field_.plane.to_global(p.at);
      w.reverse = p.reverse;
      w.turn = p.turn;
      out_.items.emplace_back(w);
      path.push_back(p.at);
    }
    measure(path);
    const Cover cover = cover_of(field_.area, part_.area(), path, spacing_m_ / 2.0);
    out_.covered_share = cover.covered;
    out_.reachable_share = cover.reachable;
    if (request_.turn == SurveyTurn::Pivot) return;
    out_.tight_turns = tight_turns(drawer.points(), request_.radius_m);
    if (out_.tight_turns == 0) return;
    out_.notes.push_back(std::to_string(out_.tight_turns) +
                         " turns are sharper than the radius: more headland passes make room, and "
                         "order \"skip\" makes turns between tracks wider");
  }

  /// Length, and the time that it takes: turns of more than 30° stand, others are driven through.
  void measure(const std::vector<EnuPoint>& path) {
    constexpr double kDriven_rad = 0.52;
    constexpr double kStop_s = 1.5;  // to stop and to start again
    double turning_s = 0.0;
    for (std::size_t i = 1; i < path.size(); ++i) {
      out_.length_m += base::distance_m(path[i - 1], path[i]);
      if (i + 1 == path.size()) break;
      const EnuPoint a = path[i] - path[i - 1];
      const EnuPoint b = path[i + 1] - path[i];
      const double turn = std::abs(
          base::angle_diff_rad(std::atan2(a.north_m, a.east_m), std::atan2(b.north_m, b.east_m)));
      if (turn > kDriven_rad) turning_s += kStop_s + turn / request_.turn_rate_radps;
    }
    out_.time_s = out_.length_m / request_.speed_mps + turning_s;
  }

  const SurveyRequest& request_;
  const Field field_;
  const double spacing_m_;
  const double border_m_;
  const double ring_step_m_;
  const double sagitta_m_;
  Part part_;
  Area open_;  ///< what tracks have to cover
  int rings_ = 0;
  EnuPoint start_;
  Survey out_;
};

}  // namespace
}  // namespace survey

base::Result<Survey> plan_survey(const SurveyRequest& request) {
  if (auto fine = survey::check(request); !fine) return tl::unexpected<base::Error>(fine.error());
  auto field = survey::field_of(request.rings);
  if (!field) return tl::unexpected<base::Error>(std::move(field.error()));
  return survey::Planner(request, std::move(*field)).plan();
}

}  // namespace roverd::mission
