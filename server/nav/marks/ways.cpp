#include "nav/marks/ways.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/angle.hpp"
#include "nav/marks/pieces.hpp"

namespace roverd::nav::marks {
namespace {

constexpr double kStep_m = 0.05;
/// So far behind the vehicle a way begins, so that a corner that it is in keeps its roundness.
constexpr double kBehind_m = 1.5;
constexpr double kMostArc_rad = base::kPi * 0.6;  // 108°
constexpr double kArcPiece_rad = base::kPi / 18.0;
/// The wall's nearest point lies so far ahead or behind of square to the way at most.
constexpr double kAhead_rad = base::kPi * 5.0 / 6.0;
constexpr double kAstern_rad = base::kPi / 2.2;
constexpr double kStart_rad = base::kPi * 80.0 / 180.0;
constexpr double kCorner_rad = base::kPi / 12.0;
constexpr double kNever = 1e9;
constexpr double kGlance_s = 0.5;
/// A wall that is seen ahead only and lies more across the heading is none beside the vehicle: cos.
constexpr double kBeside = 0.5;

Vec2 unit(Vec2 v) noexcept {
  return (1.0 / std::max(1e-12, length(v))) * v;
}
Vec2 left_of(Vec2 v) noexcept {
  return {-v.y, v.x};
}
double turn_from(Vec2 a, Vec2 b) noexcept {
  return std::atan2(sense::cross(a, b), sense::dot(a, b));
}
EnuPoint point(Vec2 p) noexcept {
  return {p.x, p.y};
}

struct Nearest {
  Vec2 at{};
  double distance_m = kNever;
  std::size_t piece = 0;
  bool end = false;  ///< of its piece
};

/// @param may whether the direction to it counts
template <class May>
Nearest nearest(const std::vector<Piece>& pieces, Vec2 from, May&& may) {
  Nearest best;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Vec2 ab = pieces[i].b - pieces[i].a;
    const double square = std::max(1e-12, sense::dot(ab, ab));
    const double part = std::clamp(sense::dot(from - pieces[i].a, ab) / square, 0.0, 1.0);
    const Vec2 at = pieces[i].a + part * ab;
    const double distance_m = length(at - from);
    if (distance_m >= best.distance_m || distance_m < 1e-6 || !may(at - from)) continue;
    best = {at, distance_m, i, part <= 0.0 || part >= 1.0};
  }
  return best;
}

/// One place of the way: on a straight, or on the arc about a wall's end.
struct Sample {
  Vec2 at{};
  Vec2 along{};
  Nearest wall;
};

/// Drives a point along the curve at the distance from the walls.
class March {
 public:
  /// @param door_m so far a wall may go on where nothing tells that it ends
  March(std::vector<Piece>& pieces, Side side, double distance_m, double door_m)
      : pieces_(pieces),
        sign_(side == Side::Left ? 1.0 : -1.0),
        distance_m_(distance_m),
        door_m_(door_m) {}

  /// @param ahead_m so far ahead a wall may begin that is beside the vehicle, too
  /// @return false: there is no wall on that side.
  bool begin(const Pose2& pose, double ahead_m) {
    const Vec2 here{pose.x_m, pose.y_m};
    const Vec2 heading{std::cos(pose.yaw_rad), std::sin(pose.yaw_rad)};
    const Vec2 to_side = sign_ * left_of(heading);
    const auto beside = [&](Vec2 to) { return std::abs(turn_from(to_side, to)) < kStart_rad; };
    const double most_m = 3.0 * distance_m_ + 1.0;
    Nearest wall = nearest(pieces_, here, beside);
    const bool known = wall.distance_m <= most_m && !opens_at(wall);
    if (!known && go_back(here, heading, ahead_m)) wall = nearest(pieces_, here, beside);
    if (wall.distance_m > most_m) return false;
    if (may_go_on(wall) && go_on(wall)) wall = nearest(pieces_, here, beside);
    const Vec2 back = unit(here - wall.at);
    samples_.push_back({wall.at + distance_m_ * back, along(-1.0 * back), wall});
    start_ = samples_.front();
    return true;
  }

  WayEnd run(double way_m) {
    // Part of an arc may lie behind already.
    double arc_rad =
        start_.wall.end
            ? std::abs(turn_from(pieces_[start_.wall.piece].normal, start_.at - start_.wall.at))
            : 0.0;
    for (double gone_m = 0.0; gone_m < way_m; gone_m += kStep_m) {
      const Sample last = samples_.back();
      const Vec2 next = last.at + kStep_m * last.along;
      const auto aside = [&](Vec2 to) {
        const double off = sign_ * turn_from(last.along, to);  // π/2: square to the way
        return off > base::kPi / 2.0 - kAhead_rad && off < base::kPi / 2.0 + kAstern_rad;
      };
      Nearest wall = nearest(pieces_, next, aside);
      if (may_go_on(wall)) {
        if (!go_on(wall)) return WayEnd::NoEcho;
        wall = nearest(pieces_, next, aside);
      }
      if (wall.distance_m > distance_m_ + 2.0 * kStep_m) return WayEnd::WallEnds;
      const Vec2 back = unit(next - wall.at);
      const Sample now{wall.at + distance_m_ * back, along(-1.0 * back), wall};
      if (sense::dot(now.at - last.at, last.along) < 0.1 * kStep_m && !turns(last, now)) {
        return WayEnd::TooNarrow;
      }
      const bool about = now.wall.end && last.wall.end && length(now.wall.at - last.wall.at) < 1e-6;
      arc_rad = about ? arc_rad + std::abs(turn_from(last.along, now.along)) : 0.0;
      if (arc_rad > kMostArc_rad) return WayEnd::WallEnds;
      samples_.push_back(now);
    }
    return WayEnd::Horizon;
  }

  const Sample& start() const noexcept { return start_; }
  /// Past where a wall is not seen any further, though nothing told that it ends.
  bool went_on() const noexcept { return !went_on_.empty(); }
  /// When the wall beside it was seen last.
  base::Time seen_at() const noexcept { return beside().seen_at; }
  /// The wall beside it.
  const Piece& beside() const noexcept { return pieces_[start_.wall.piece]; }
  const std::vector<Sample>& samples() const noexcept { return samples_; }

 private:
  /// Where the wall begins for who drives along it.
  bool begins_at_a(const Piece& p) const noexcept {
    return sign_ * sense::cross(p.normal, p.b - p.a) > 0.0;
  }
  /// It is the beginning of a wall, at the edge of what was looked at.
  bool opens_at(const Nearest& wall) const noexcept {
    const Piece& p = pieces_[wall.piece];
    const bool at_a = begins_at_a(p);
    return wall.end && (at_a ? p.a_open : p.b_open) && length(wall.at - (at_a ? p.a : p.b)) < 1e-6;
  }
  /// It is where a wall is not seen any further, and nothing told that it ends.
  bool may_go_on(const Nearest& wall) const noexcept {
    if (wall.distance_m >= kNever) return false;
    const Piece& p = pieces_[wall.piece];
    const bool to_a = !begins_at_a(p);
    return wall.end && !(to_a ? p.a_ends : p.b_ends) && length(wall.at - (to_a ? p.a : p.b)) < 1e-6;
  }
  /// On along its line, once. @return false: it was before.
  bool go_on(const Nearest& wall) {
    if (std::ranges::find(went_on_, wall.piece) != went_on_.end()) return false;
    went_on_.push_back(wall.piece);
    Piece& p = pieces_[wall.piece];
    const Vec2 along = unit(p.b - p.a);
    if (begins_at_a(p)) {
      p.b = p.b + door_m_ * along;
    } else {
      p.a = p.a - door_m_ * along;
    }
    return true;
  }
  /// The wall that lies nearest aside, of those of which nothing but what is ahead is seen, goes
  /// back along its line until it is beside the vehicle. @return there is one.
  bool go_back(Vec2 here, Vec2 heading, double ahead_m) {
    Piece* best = nullptr;
    double least_m = kNever;
    for (Piece& p : pieces_) {
      const Vec2 along = sign_ * left_of(p.normal);
      const bool at_a = begins_at_a(p);
      const double far_m = sense::dot((at_a ? p.a : p.b) - here, along);
      const double aside_m = sense::dot(p.normal, here - p.a);
      const bool open = at_a ? p.a_open : p.b_open;
      if (!open || far_m <= 0.0 || far_m > ahead_m) continue;
      if (aside_m <= 0.0 || aside_m >= least_m || sense::dot(heading, along) < kBeside) continue;
      best = &p;
      least_m = aside_m;
    }
    if (best == nullptr) return false;
    Vec2& begin = begins_at_a(*best) ? best->a : best->b;
    const Vec2 along = sign_ * left_of(best->normal);
    begin = begin - (sense::dot(begin - here, along) + kBehind_m) * along;
    return true;
  }
  Vec2 along(Vec2 to_wall) const noexcept { return -sign_ * left_of(to_wall); }
  static bool turns(const Sample& last, const Sample& now) noexcept {
    return std::abs(turn_from(last.along, now.along)) > kCorner_rad;
  }

  std::vector<Piece>& pieces_;
  const double sign_;
  const double distance_m_;
  const double door_m_;
  std::vector<std::size_t> went_on_;  ///< pieces
  std::vector<Sample> samples_;
  Sample start_;
};

/// From samples to vertices: straights by their ends, arcs by pieces, corners where two straights
/// meet.
class Drawing {
 public:
  Drawing(double speed_mps, double corner_m, double arc_1pm) : arc_1pm_(arc_1pm) {
    common_.speed_mps = speed_mps;
    common_.deviation_m = corner_m;
    common_.turn = mission::Turn::Arc;
  }

  Way take(const std::vector<Sample>& samples) {
    const Sample& first = samples.front();
    straight(first.at - kBehind_m * first.along);
    for (std::size_t i = 0; i < samples.size();) {
      std::size_t last = i;
      while (last + 1 < samples.size() && same(samples[i], samples[last + 1])) ++last;
      if (on_arc(samples, i, last)) {
        arc(samples, i, last);
      } else if (i > 0) {
        const bool met = corner(samples[i - 1], samples[i]);
        if (!met && length(samples[i].at - at_) > 0.5 * kStep_m) straight(samples[i].at);
      }
      if (last > i && !on_arc(samples, i, last)) straight(samples[last].at);
      i = last + 1;
    }
    return std::move(way_);
  }

 private:
  static bool same(const Sample& a, const Sample& b) noexcept {
    if (a.wall.end != b.wall.end) return false;
    return a.wall.end ? length(a.wall.at - b.wall.at) < 1e-6 : a.wall.piece == b.wall.piece;
  }
  static bool on_arc(const std::vector<Sample>& samples, std::size_t i, std::size_t last) {
    return samples[i].wall.end && last > i;
  }
  void put(Vec2 at, double curvature_1pm, bool tangent) {
    Vertex v = common_;
    v.at = point(at);
    v.curvature_1pm = curvature_1pm;
    v.tangent = tangent;
    way_.vertices.push_back(v);
    at_ = at;
  }
  void straight(Vec2 at) { put(at, 0.0, false); }
  /// @return the way bends here by more than the law follows without a rounding.
  bool corner(const Sample& before, const Sample& after) {
    if (before.wall.end || after.wall.end) return false;
    if (std::abs(turn_from(before.along, after.along)) < kCorner_rad) return false;
    const double det = sense::cross(before.along, after.along);
    const double ahead_m = sense::cross(after.at - before.at, after.along) / det;
    if (std::abs(ahead_m) > 10.0 * kStep_m) return false;
    const Vec2 at = before.at + ahead_m * before.along;
    // It replaces the last sample before it: they are a step apart.
    if (way_.vertices.size() > 1 && length(at_ - at) < 3.0 * kStep_m) way_.vertices.pop_back();
    way_.corners.push_back(way_.vertices.size());
    straight(at);
    return true;
  }
  void arc(const std::vector<Sample>& samples, std::size_t first, std::size_t last) {
    // Exactly where it leaves the straight: abeam of the wall's end.
    double turned_rad = 0.0;
    if (first > 0) {
      const Vec2 along = samples[first - 1].along;
      const Vec2 begin = samples[first].wall.at - (1.0 / arc_1pm_) * left_of(along);
      const bool back = sense::dot(begin - at_, along) < 1e-3;
      if (back && way_.vertices.size() > 1) way_.vertices.pop_back();
      straight(begin);
      turned_rad = std::abs(turn_from(along, samples[first].along));
    } else {
      straight(samples[first].at);
    }
    way_.vertices.back().tangent = true;
    for (std::size_t i = first + 1; i <= last; ++i) {
      turned_rad += std::abs(turn_from(samples[i - 1].along, samples[i].along));
      if (turned_rad < kArcPiece_rad && i != last) continue;
      turned_rad = 0.0;
      put(samples[i].at, arc_1pm_, true);
    }
  }

  const double arc_1pm_;
  Vertex common_;
  Way way_;
  Vec2 at_{};
};

double left_offset(Vec2 at, Vec2 along, Vec2 here) noexcept {
  return sense::dot(left_of(along), here - at);
}

/// Where a straight from `from` touches the circle about `middle`, which lies on `sign`'s side.
Vec2 touching(Vec2 from, Vec2 middle, double radius_m, double sign) noexcept {
  const Vec2 to = middle - from;
  const double off_rad = std::asin(std::min(1.0, radius_m / std::max(1e-9, length(to))));
  const double yaw_rad = std::atan2(to.y, to.x) - sign * off_rad;
  const Vec2 along{std::cos(yaw_rad), std::sin(yaw_rad)};
  return middle - (sign * radius_m) * left_of(along);
}

}  // namespace

std::optional<Way> wall_way(std::span<const Wall> walls, const Pose2& pose, Side side,
                            double distance_m, double speed_mps, base::Time now,
                            const WallParams& params) {
  std::vector<Piece> pieces = pieces_of(walls, params.door_m);
  close_corners(pieces);
  March march(pieces, side, distance_m, params.door_m);
  if (!march.begin(pose, params.max_range_m)) return std::nullopt;
  // A wall that is not seen any more is gone on along as far as a door is wide.
  const double unseen_s = base::seconds(now - march.seen_at()) - kGlance_s;
  const bool dark = unseen_s > 0.0;
  const double way_m = dark ? params.door_m - speed_mps * unseen_s : params.way_m;
  WayEnd end = march.run(way_m);
  if (dark && end == WayEnd::Horizon) end = march.went_on() ? WayEnd::NoEcho : WayEnd::NotSeen;
  if (march.samples().size() < 2) return std::nullopt;
  const double sign = side == Side::Left ? 1.0 : -1.0;
  Way way = Drawing(speed_mps, params.corner_m, sign / distance_m).take(march.samples());
  way.end = end;
  way.here_m = kBehind_m;
  way.scanned_at = march.beside().scanned_at;
  way.imaged_at = march.beside().imaged_at;
  way.offset_m = left_offset(march.start().at, march.start().along, {pose.x_m, pose.y_m});
  return way;
}

Way landmark_way(std::span<const Vec2> chain, std::span<const Vec2> behind, const Pose2& pose,
                 Side side, double speed_mps, const LandmarkParams& params) {
  const double sign = side == Side::Left ? 1.0 : -1.0;
  const double offset_m = params.offset_m;
  Way way;
  way.end = WayEnd::LastLandmark;
  Vertex common;
  common.speed_mps = speed_mps;
  common.turn = mission::Turn::Arc;
  common.deviation_m = params.corner_m;
  const auto put = [&](Vec2 at, double curvature_1pm, bool tangent) {
    common.at = point(at);
    common.curvature_1pm = curvature_1pm;
    common.tangent = tangent;
    way.vertices.push_back(common);
  };
  for (const Vec2 p : behind) put(p, 0.0, false);
  Vec2 last = behind.back();
  Vec2 along = behind.size() > 1 ? unit(last - behind[behind.size() - 2])
                                 : Vec2{std::cos(pose.yaw_rad), std::sin(pose.yaw_rad)};
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Vec2 in = touching(last, chain[i], offset_m, sign);
    const Vec2 in_along = unit(in - last);
    const bool more = i + 1 < chain.size();
    const Vec2 out_along = more ? unit(chain[i + 1] - chain[i]) : in_along;
    const double turn_rad = turn_from(in_along, out_along);
    if (sign * turn_rad > kArcPiece_rad) {
      // Around it: an arc, left where the way to the next one begins.
      put(in, 0.0, true);
      const int pieces = static_cast<int>(std::ceil(std::abs(turn_rad) / kArcPiece_rad));
      for (int k = 1; k <= pieces; ++k) {
        const double yaw_rad = std::atan2(in_along.y, in_along.x) + turn_rad * k / pieces;
        const Vec2 now{std::cos(yaw_rad), std::sin(yaw_rad)};
        last = chain[i] - (sign * offset_m) * left_of(now);
        put(last, sign / offset_m, true);
      }
      along = out_along;
    } else {
      const Vec2 middle = unit(in_along + out_along);
      // Its rounding leads away from the landmark: the corner itself lies so much nearer.
      const bool bends = std::abs(turn_rad) > kArcPiece_rad;
      if (bends) way.corners.push_back(way.vertices.size());
      const double beside_m = bends ? offset_m - common.deviation_m : offset_m;
      last = chain[i] - (sign * beside_m) * left_of(middle);
      put(last, 0.0, false);
      along = in_along;
    }
  }
  put(last + params.on_m * along, 0.0, false);
  const Vec2 here{pose.x_m, pose.y_m};
  const Vec2 first = behind.back();
  const EnuPoint second = way.vertices[behind.size()].at;
  const Vec2 ahead = unit(Vec2{second.east_m, second.north_m} - first);
  for (std::size_t i = 1; i < behind.size(); ++i) way.here_m += length(behind[i] - behind[i - 1]);
  way.here_m += std::max(0.0, sense::dot(ahead, here - first));
  way.offset_m = left_offset(first, ahead, here);
  return way;
}

}  // namespace roverd::nav::marks
