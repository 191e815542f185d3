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
  return {w.at(s.from_m), w.at(s.to_m), w.normal, w.seen_at, s.from_open, s.to_open};
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
      const auto nearer_end = [&](Piece& p) -> Vec2& {
        return length(p.a - meet) < length(p.b - meet) ? p.a : p.b;
      };
      Vec2& of_one = nearer_end(pieces[i]);
      Vec2& of_other = nearer_end(pieces[j]);
      if (length(of_one - meet) > kMeet_m || length(of_other - meet) > kMeet_m) continue;
      of_one = of_other = meet;
    }
  }
}

}  // namespace roverd::nav::marks
