#pragma once
// The walls that are known, kept over time in the odometry's frame O: what a scan or a vision
// program tells again is the same wall, a door in it is a gap of the same wall, and what the scan
// looks through is gone.
//
//   seen ──3 times──▶ believed ──unseen for keep_s, or looked through──▶ forgotten
//
// A wall's line is the fit over all of its points, older ones fading by kFade a scan; its
// certainty is that of the fit. One vision plane counts as 2 kPlanePlaces points.
//
// Where a scan's first or last beam met it a wall is open: it may go on there. A vision plane tells
// neither where it begins nor where it ends, so both of its ends are. A scan that sees an end
// closes it.
//
// Where nothing comes back any more a wall need not end: glass, a mirror and black paint give no
// echo. It was seen to end only where something was met behind its line, close beyond the end: its
// face, or whatever stands there.
//
//   eye ·
//        \  ╲ ·
//   ══════╗\  ╲         met behind the line: the wall ends
//   ──────╝
//
// Bounded: kMostWalls, kMostStretches each. Not shared between threads; time comes with the scans.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/vision.hpp"
#include "nav/marks/lines.hpp"
#include "nav/marks/source.hpp"

namespace roverd::nav::marks {

/// Seen of a wall: from and to, metres along it.
struct Stretch {
  double from_m = 0.0;
  double to_m = 0.0;
  bool from_open = false;  ///< the edge of what was looked at: no end of the wall
  bool to_open = false;
};

/// So many echoes from behind a wall's line, close beyond one place of it, make that place its end.
constexpr int kEndsHits = 6;

/// Where a wall may have been seen to end.
struct SeenEnd {
  double at_m = 0.0;   ///< along the wall
  bool ahead = false;  ///< it ends there for who goes along `along`; else it begins there
  int hits = 0;        ///< echoes from behind its line, close beyond
};

struct Wall {
  std::uint32_t id = 0;  ///< never given again
  Source source = Source::Scan;
  Vec2 anchor{};              ///< on it, in O: where `along` counts from
  Vec2 along{1.0, 0.0};       ///< of length 1
  Vec2 normal{};              ///< of length 1, to the side from which it was seen
  std::vector<Stretch> seen;  ///< in order; what lies between two is a gap
  std::vector<SeenEnd> ends;
  double sigma_m = 0.0;  ///< 1σ beside it
  double sigma_rad = 0.0;
  int hits = 0;
  bool believed = false;
  base::Time seen_at;
  base::Time scanned_at{};  ///< a scan told it last
  base::Time imaged_at{};   ///< a vision program did

  Vec2 at(double along_m) const noexcept { return anchor + along_m * along; }
  /// Something told that it ends there, within 0.3 m.
  bool ends_at(double along_m, bool ahead) const noexcept;
  /// From the line without ends, positive on the side from which it was seen.
  double distance_m(Vec2 p) const noexcept { return sense::dot(normal, p - anchor); }
};

/// A vision program's wall: its largest plane of at least min_plane_size, ahead of the camera
/// (a negative depth is a false one), and upright. In B. Empty: none.
struct PlaneWall {
  Vec2 centre{};
  Vec2 normal{};            ///< of length 1, towards the body's origin
  double distance_m = 0.0;  ///< of the body's origin: the centre projected on the normal
  double size = 0.0;
};
std::optional<PlaneWall> wall_of(const base::Vision& vision, const base::Mount& mount,
                                 const WallParams& params) noexcept;

class Walls {
 public:
  static constexpr std::size_t kMostWalls = 64;
  static constexpr std::size_t kMostStretches = 32;

  void take(const PlanarScan& scan, const WallParams& params);
  /// @param pose X_OB when the image was taken
  void take(const PlaneWall& plane, const Pose2& pose, base::Time stamp, const WallParams& params);
  /// The odometry began anew.
  void forget() noexcept { walls_.clear(); }
  /// Those that are not seen any more; once in a while.
  void expire(base::Time now, Vec2 here, const WallParams& params);

  /// Believed and not yet.
  std::vector<Wall> all() const;
  /// Those that are not known yet are counted from here on.
  void number_from(std::uint32_t first) noexcept { next_ = first; }

 private:
  struct Kept {
    Wall wall;
    Moments moments;
    std::vector<Stretch> now;  ///< of the scan in hand
    double rms_m = 0.0;        ///< of its worst line in that scan
    int misses = 0;
    bool matched = false;
  };
  void put(const Line& line_in_o, Source source, base::Time stamp, const WallParams& params);
  void look_through(const PlanarScan& scan);
  void look_past_ends(const PlanarScan& scan);
  void merge(const WallParams& params);

  std::vector<Kept> walls_;
  std::uint32_t next_ = 1;
};

}  // namespace roverd::nav::marks
