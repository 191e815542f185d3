#include "nav/marks/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/angle.hpp"

namespace roverd::nav::marks {
namespace {

constexpr double kOneWall_rad = base::kPi / 12.0;  ///< flatter, they are one wall
constexpr double kMeet_m = 0.2;

Piece piece_of(const Wall& w, const Stretch& s) {
  return {w.at(s.from_m),
          w.at(s.to_m),
          w.normal,
          w.seen_at,
          s.from_open,
          s.to_open,
          w.ends_at(s.from_m, false),
          w.ends_at(s.to_m, true),
          w.scanned_at,
          w.imaged_at};
}

}  // namespace

std::vector<Piece> pieces_of(std::span<const Wall> walls, double door_m) {
  std::vector<Piece> out;
  for (const Wall& w : walls) {
    if (!w.believed || w.seen.empty()) continue;
    Stretch now = w.seen.front();
    for (const Stretch& s : w.seen) {
      if (s.from_m - now.to_m > door_m) {
        out.push_back(piece_of(w, now));
        now = s;
      }
      now.to_open = s.to_m >= now.to_m ? s.to_open : now.to_open;
      now.to_m = std::max(now.to_m, s.to_m);
    }
    out.push_back(piece_of(w, now));
  }
  return out;
}

void close_corners(std::vector<Piece>& pieces) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (std::size_t j = i + 1; j < pieces.size(); ++j) {
      const Vec2 u = pieces[i].b - pieces[i].a;
      const Vec2 v = pieces[j].b - pieces[j].a;
      const double det = sense::cross(u, v);
      if (std::abs(det) < std::sin(kOneWall_rad) * length(u) * length(v)) continue;
      const Vec2 meet = pieces[i].a + (sense::cross(pieces[j].a - pieces[i].a, v) / det) * u;
      const auto at_a = [&](const Piece& p) { return length(p.a - meet) < length(p.b - meet); };
      const auto off_m = [&](const Piece& p) { return length((at_a(p) ? p.a : p.b) - meet); };
      if (off_m(pieces[i]) > kMeet_m || off_m(pieces[j]) > kMeet_m) continue;
      for (Piece* p : {&pieces[i], &pieces[j]}) {
        const bool a = at_a(*p);
        (a ? p->a : p->b) = meet;
        (a ? p->a_ends : p->b_ends) = true;
      }
    }
  }
}

}  // namespace roverd::nav::marks
