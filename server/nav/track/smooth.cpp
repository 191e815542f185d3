#include "nav/track/smooth.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"
#include "nav/track/smooth_fit.hpp"

namespace roverd::nav {
namespace {

using base::rad_from_deg;

constexpr double kShort_m = 2.0;  // longer legs are meant as they are
constexpr std::size_t kFewest = 4;
constexpr double kLead_m = 2.0;  // how far a curve reaches into a long leg
constexpr double kLeadPart = 0.4;
constexpr int kTries = 4;
constexpr double kComfortable_1pm = 1.0 / 0.6;
constexpr double kGiveUp_m = 0.7;  // about a place that cannot be kept within the tolerance
constexpr double kMoveCorner = 0.8;
constexpr double kRoomBeside_m = 0.015;
constexpr double kNoiseTurns_rad = 0.25;  // 1 sigma: a turn seen by so short legs is none

EnuPoint towards(EnuPoint from, EnuPoint to, double by_m) noexcept {
  const double part = by_m / base::distance_m(from, to);
  return {from.east_m + part * (to.east_m - from.east_m),
          from.north_m + part * (to.north_m - from.north_m)};
}

/// Vertices first … last, and how far the curve reaches into the long legs beside them.
struct Piece {
  std::size_t first = 0;
  std::size_t last = 0;
  double lead_in_m = 0.0;
  double lead_out_m = 0.0;
  bool held = false;  ///< its ends are
  Chain chain{};
  std::vector<CurvePoint> points{};
  std::vector<std::size_t> corners{};
  Apart apart{};

  bool fitted() const noexcept { return !points.empty(); }
  /// Index in the chain of its first vertex.
  std::size_t offset() const noexcept { return lead_in_m > 0.0 ? 1 : 0; }
};

class Smoother {
 public:
  Smoother(std::span<const Vertex> v, const PathParams& params)
      : v_(v), params_(params), cut_(v.size(), Cut::None), moved_(v.size()) {
    const bool steered = params.vehicle.steered();
    const double least_m = min_radius_m(params.vehicle);
    limits_.tolerance_m = params.track.smooth_m;
    limits_.corner_rad = rad_from_deg(std::clamp(params.pivot.angle_deg, 20.0, 150.0));
    if (!steered) {
      limits_.sharpest_1pm = kComfortable_1pm;
    } else {
      limits_.shortest_m = std::max(limits_.shortest_m, least_m);
      limits_.sharpest_1pm = 1.0 / least_m;
      limits_.corner_rad = rad_from_deg(30.0);
    }
    corner_reach_m_ = std::max(0.6, 0.5 * least_m);
    corner_rad_ = rad_from_deg(steered ? 60.0 : 70.0);
  }

  SmoothedWay lay() {
    for (std::size_t k = 0; k < v_.size(); ++k) {
      moved_[k] = v_[k].at;
      const bool inside = k > 0 && k + 1 < v_.size();
      const bool same = inside && v_[k].reverse == v_[k + 1].reverse;
      if (!same || !v_[k].dense || v_[k].stop) cut_[k] = Cut::Hard;
    }
    split();
    for (const Piece& piece : pieces_) find_corners(piece);
    for (int round = 0; round < kTries; ++round) {
      split();
      fit_all(false);
      if (!take_corners()) break;
    }
    place_corners();
    for (int round = 0; round < kTries; ++round) {
      split();
      fit_all(true);
      if (!give_up_places()) break;
    }
    for (Piece& piece : pieces_) {
      if (piece.apart.beyond_m > 0.0) piece.points.clear();
    }
    return way();
  }

 private:
  enum class Cut : char { None, Corner, Hard };

  bool is_long(std::size_t leg) const noexcept {
    return base::distance_m(v_[leg].at, v_[leg + 1].at) > kShort_m;
  }

  double lead_m(std::size_t leg) const noexcept {
    return std::min(kLead_m, kLeadPart * base::distance_m(v_[leg].at, v_[leg + 1].at));
  }

  /// What lies between cuts and long legs. Pieces that are there already stay.
  void split() {
    std::map<std::size_t, Piece> before;
    for (Piece& piece : pieces_) before.emplace(piece.first, std::move(piece));
    pieces_.clear();
    for (std::size_t k = 0; k + 1 < v_.size();) {
      Piece piece;
      piece.first = piece.last = k;
      while (piece.last + 1 < v_.size() && !is_long(piece.last)) {
        ++piece.last;
        if (cut_[piece.last] != Cut::None) break;
      }
      k = std::max(piece.last, k + 1);
      if (piece.last - piece.first + 1 < kFewest) continue;
      if (cut_[piece.first] == Cut::None) piece.lead_in_m = lead_m(piece.first - 1);
      if (cut_[piece.last] == Cut::None) piece.lead_out_m = lead_m(piece.last);
      const auto old = before.find(piece.first);
      const bool same = old != before.end() && old->second.last == piece.last;
      pieces_.push_back(same ? std::move(old->second) : std::move(piece));
    }
  }

  /// Turns that are sharp whatever the noise: seen from a little way before and behind. Where an
  /// end leaves so little way that noise alone turns it, it says nothing.
  void find_corners(const Piece& piece) {
    std::vector<EnuPoint> at;
    for (std::size_t k = piece.first; k <= piece.last; ++k) at.push_back(v_[k].at);
    const Chain chain = chain_of(std::move(at));
    const double noise = noise_m(chain);
    const auto turn_at = [&](std::size_t i) {
      const EnuPoint a = chain.place(chain.u[i] - corner_reach_m_);
      const EnuPoint b = chain.place(chain.u[i] + corner_reach_m_);
      const double before_m = base::distance_m(a, chain.at[i]);
      const double behind_m = base::distance_m(b, chain.at[i]);
      if (before_m < 0.01 || behind_m < 0.01) return 0.0;
      // All three points have it, the middle one turns both legs.
      const double turned_rad =
          noise * std::hypot(1.0 / before_m, 1.0 / behind_m, 1.0 / before_m + 1.0 / behind_m);
      const bool cut =
          chain.u[i] < corner_reach_m_ || chain.u[i] + corner_reach_m_ > chain.u.back();
      if (cut && turned_rad > kNoiseTurns_rad) return 0.0;
      return std::abs(
          base::angle_diff_rad(direction_rad(a, chain.at[i]), direction_rad(chain.at[i], b)));
    };
    std::size_t best = 0;  // 0: none
    double best_rad = 0.0;
    const auto take = [&] {
      if (best > 0) cut_[piece.first + best] = Cut::Corner;
      best = 0;
      best_rad = 0.0;
    };
    for (std::size_t i = 1; i + 1 < chain.at.size(); ++i) {
      if (best > 0 && chain.u[i] > chain.u[best] + corner_reach_m_) take();
      const double turn = turn_at(i);
      if (turn < corner_rad_ || turn <= best_rad) continue;
      best = i;
      best_rad = turn;
    }
    take();
  }

  void fit_all(bool held) {
    for (Piece& piece : pieces_) {
      if (!piece.fitted() || (held && !piece.held)) fit(piece, held);
    }
  }

  void fit(Piece& piece, bool held) {
    std::vector<EnuPoint> at;
    const std::size_t a = piece.first;
    const std::size_t b = piece.last;
    piece.held = held || (cut_[a] != Cut::Corner && cut_[b] != Cut::Corner);
    if (piece.lead_in_m > 0.0) at.push_back(towards(v_[a].at, v_[a - 1].at, piece.lead_in_m));
    for (std::size_t k = a; k <= b; ++k) at.push_back(v_[k].at);
    if (piece.lead_out_m > 0.0) at.push_back(towards(v_[b].at, v_[b + 1].at, piece.lead_out_m));
    piece.chain = chain_of(std::move(at));
    PieceEnds ends;
    ends.straight_in = piece.lead_in_m > 0.0;
    ends.straight_out = piece.lead_out_m > 0.0;
    if (ends.straight_in) {
      ends.begin = piece.chain.at.front();
    } else if (a > 0 && (held || cut_[a] == Cut::Hard)) {  // where it begins, it only comes to
      ends.begin = moved_[a];
    }
    if (ends.straight_out) {
      ends.end = piece.chain.at.back();
    } else if (held || cut_[b] == Cut::Hard) {
      ends.end = moved_[b];
    }
    FitLimits limits = limits_;
    limits.noise_m = std::max(noise_m(piece.chain), 0.001);
    const PieceFit curve(std::move(piece.chain), ends, limits);
    piece.chain = curve.chain();
    piece.points = curve.points();
    piece.corners = held ? std::vector<std::size_t>{} : curve.corners();
    make_room(piece);
    piece.apart = apart(piece.chain, piece.points, limits);
    if (!drivable(piece)) piece.apart.beyond_m = 1e9;
  }

  /// A curve that turns back on itself is none.
  static bool drivable(Piece& piece) {
    const auto& p = piece.points;
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
      const double turn = base::angle_diff_rad(direction_rad(p[i - 1].at, p[i].at),
                                               direction_rad(p[i].at, p[i + 1].at));
      if (std::abs(turn) < rad_from_deg(30.0)) continue;
      piece.apart.u = p[i].u;
      return false;
    }
    return true;
  }

  /// An arc or a swing at its end needs straight ground before it.
  void make_room(Piece& piece) const {
    const auto needs = [this](std::size_t k) {
      const Vertex& v = v_[k];
      const bool arc = v.turn == mission::Turn::Arc || v.turn == mission::Turn::Through;
      return !v.stop && k > 0 && k + 1 < v_.size() && v.reverse == v_[k + 1].reverse &&
             (params_.vehicle.steered() || arc || params_.pivot.angle_deg > 60.0);
    };
    const double room_m = std::max(1.0, 4.0 * min_radius_m(params_.vehicle));
    auto& p = piece.points;
    const auto clear = [&] {
      std::size_t n = 1;
      while (n + 2 < p.size()) {
        const EnuPoint a = p.front().at;
        const EnuPoint d = p[n + 1].at - a;
        const double length = std::hypot(d.east_m, d.north_m);
        bool straight = length > 0.01 && length < room_m;
        for (std::size_t i = 1; i <= n && straight; ++i) {
          const EnuPoint q = p[i].at - a;
          straight = std::abs(d.east_m * q.north_m - d.north_m * q.east_m) < kRoomBeside_m * length;
        }
        if (!straight) break;
        ++n;
      }
      p.erase(p.begin() + 1, p.begin() + static_cast<std::ptrdiff_t>(n));
      if (n > 1) p.front().curvature_1pm = 0.0;
    };
    if (piece.lead_in_m == 0.0 && needs(piece.first)) clear();
    if (piece.lead_out_m > 0.0 || !needs(piece.last)) return;
    std::reverse(p.begin(), p.end());
    clear();
    std::reverse(p.begin(), p.end());
    if (p.size() > 1) p[p.size() - 2].curvature_1pm = 0.0;
  }

  bool take_corners() {
    bool any = false;
    for (const Piece& piece : pieces_) {
      for (const std::size_t i : piece.corners) {
        const std::size_t k = piece.first + i - piece.offset();
        if (i < piece.offset() || k >= v_.size() || cut_[k] != Cut::None) continue;
        cut_[k] = Cut::Corner;
        any = true;
      }
    }
    return any;
  }

  const Piece* piece_at(std::size_t k, bool ends) const noexcept {
    for (const Piece* piece : {ends ? ending_[k] : nullptr, ends ? nullptr : beginning_[k]}) {
      if (piece != nullptr && piece->fitted()) return piece;
    }
    return nullptr;
  }

  /// Where the curves before and behind it meet: that is less of chance than the one point is.
  void place_corners() {
    ending_.assign(v_.size(), nullptr);
    beginning_.assign(v_.size(), nullptr);
    for (const Piece& piece : pieces_) {
      ending_[piece.last] = &piece;
      beginning_[piece.first] = &piece;
    }
    for (std::size_t k = 0; k < v_.size(); ++k) {
      const Piece* in = piece_at(k, true);
      const Piece* out = piece_at(k, false);
      if (cut_[k] != Cut::Corner || in == nullptr || out == nullptr) continue;
      const auto n = in->points.size();
      const EnuPoint a = in->points[n - 1].at;
      const EnuPoint b = out->points[0].at;
      const EnuPoint da = a - in->points[n - 2].at;
      const EnuPoint db = out->points[1].at - b;
      const double cross = da.east_m * db.north_m - da.north_m * db.east_m;
      const double sine =
          cross / (std::hypot(da.east_m, da.north_m) * std::hypot(db.east_m, db.north_m));
      EnuPoint meet{0.5 * (a.east_m + b.east_m), 0.5 * (a.north_m + b.north_m)};
      if (std::abs(sine) > 0.5) {
        const double t =
            ((b.east_m - a.east_m) * db.north_m - (b.north_m - a.north_m) * db.east_m) / cross;
        meet = {a.east_m + t * da.east_m, a.north_m + t * da.north_m};
      }
      if (base::distance_m(meet, v_[k].at) < kMoveCorner * limits_.tolerance_m) moved_[k] = meet;
    }
  }

  /// Where the tolerance could not be kept, the points themselves are driven.
  bool give_up_places() {
    bool any = false;
    for (Piece& piece : pieces_) {
      if (piece.apart.beyond_m <= 0.0) continue;
      for (std::size_t k = piece.first; k <= piece.last; ++k) {
        const double u = piece.chain.u[k - piece.first + piece.offset()];
        if (std::abs(u - piece.apart.u) > kGiveUp_m || cut_[k] == Cut::Hard) continue;
        cut_[k] = Cut::Hard;
        moved_[k] = v_[k].at;
        any = true;
      }
    }
    return any;
  }

  SmoothedWay way() const {
    SmoothedWay out;
    out.passed.resize(v_.size());
    out.points.reserve(v_.size());
    std::size_t next = 0;  // piece
    for (std::size_t k = 0; k < v_.size();) {
      while (next < pieces_.size() && (pieces_[next].first < k || !pieces_[next].fitted())) ++next;
      if (next < pieces_.size() && pieces_[next].first == k) {
        put_curve(out, pieces_[next]);
        k = pieces_[next].last + (pieces_[next].lead_out_m > 0.0 ? 1 : 0);
        continue;
      }
      put_vertex(out, k, 0.0);
      ++k;
    }
    return out;
  }

  void put_vertex(SmoothedWay& out, std::size_t k, double curvature_1pm) const {
    WayPoint p{v_[k], curvature_1pm, false};
    p.vertex.at = moved_[k];
    out.passed[k] = {out.points.size(), 0.0};
    out.points.push_back(p);
  }

  /// All of it but its last vertex, which what follows begins with.
  void put_curve(SmoothedWay& out, const Piece& piece) const {
    const auto& p = piece.points;
    const std::size_t offset = piece.offset();
    std::size_t k = piece.first;  // the vertex that comes next
    const auto u_of = [&](std::size_t vertex) {
      return piece.chain.u[vertex - piece.first + offset];
    };
    const bool whole = piece.lead_out_m > 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (i == 0 && offset == 0) {
        put_vertex(out, k, p[0].curvature_1pm);
        out.points.back().vertex.at = p[0].at;
        ++k;
        continue;
      }
      const bool last = i + 1 == p.size();
      for (; k <= piece.last && u_of(k) < p[i].u && (whole || k < piece.last); ++k) {
        const double from = p[i - 1].u;
        out.passed[k] = {out.points.size() - 1, (u_of(k) - from) / (p[i].u - from)};
      }
      if (last && !whole) break;
      const std::size_t leads = std::min(k, whole ? piece.last + 1 : piece.last);
      WayPoint point{v_[leads], last ? 0.0 : p[i].curvature_1pm, true};
      point.vertex.at = p[i].at;
      out.points.push_back(point);
    }
    out.stretches.push_back({piece.first, piece.last, piece.apart.m});
  }

  std::span<const Vertex> v_;
  const PathParams& params_;
  FitLimits limits_;
  double corner_reach_m_ = 0.6;
  double corner_rad_ = 1.2;
  std::vector<Cut> cut_;
  std::vector<EnuPoint> moved_;
  std::vector<Piece> pieces_;
  std::vector<const Piece*> ending_;
  std::vector<const Piece*> beginning_;
};

}  // namespace

SmoothedWay smoothed_way(std::span<const Vertex> vertices, const PathParams& params) {
  const bool any =
      std::any_of(vertices.begin(), vertices.end(), [](const Vertex& v) { return v.dense; });
  if (any && params.track.smooth_m > 0.0 && vertices.size() >= kFewest) {
    return Smoother(vertices, params).lay();
  }
  SmoothedWay out;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    out.points.push_back({vertices[k], 0.0, false});
    out.passed.push_back({k, 0.0});
  }
  return out;
}

}  // namespace roverd::nav
