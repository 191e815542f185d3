#pragma once
// Landmarks that are known, kept over time in the odometry's frame O: names and cones do not
// flicker.
//
//   seen ──confirm times──▶ believed ──in view, unseen for forget_s──▶ forgotten
//        ▲ an image that looks there in vain takes one back
// A scan names nothing: legs look like poles. What it tells must stand still besides, for kStands_s
// and away from whatever moves (standing.hpp), before it is believed; and what wanders is not
// believed any more, nor what is gone from where it stood. What is seen beside a place that is
// believed, while something moves there, is somebody who goes by. A camera's word for it stands.
// What is seen within near_m of a known one is that one: the nearest pairs first, each once. Places
// are averaged with the weight of their certainty, the older ones fading; names are what was said
// most often of late. A post of the scan has no name of its own. What a camera sees at the edge of
// its image may be cut there, and tells little of where the thing stands. Known ones within half of
// near_m of each other are one. Only who told one denies it, each by its own time; what is out of
// view is kept for a minute of driving, not of standing.
// Bounded: kMostLandmarks. Not shared between threads; time comes with what is seen.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/vision.hpp"
#include "nav/marks/params.hpp"
#include "nav/marks/posts.hpp"
#include "nav/marks/standing.hpp"
#include "nav/marks/walls.hpp"
#include "nav/sense/movers.hpp"

namespace roverd::nav::marks {

/// A bit for each sensor, by the number that whoever hands on what they see gives them: below 64.
using Eyes = std::uint64_t;
constexpr Eyes eye_of(std::size_t number) noexcept {
  return Eyes{1} << (number % 64);
}

struct Landmark {
  std::uint32_t id = 0;   ///< never given again
  std::string name;       ///< empty: nobody named it
  Vec2 at{};              ///< in O
  double sigma_m = 0.0;   ///< 1σ each way
  double radius_m = 0.0;  ///< 0: not known
  bool by_scan = false;
  bool by_vision = false;
  bool believed = false;
  base::Time seen_at;
  Eyes eyes = 0;  ///< those that told it, within a second of the last time
};

class Landmarks {
 public:
  static constexpr std::size_t kMostLandmarks = 128;
  static constexpr std::size_t kMostNames = 4;  ///< that one of them was called

  static constexpr double kStands_s = 1.5;

  /// @param eye which sensor's it is. @param movers who moves, in O
  void take(const PlanarScan& scan, const LandmarkParams& params, std::size_t eye = 0,
            std::span<const sense::Mover> movers = {});
  /// @param pose X_OB when the image was taken. @param half_view_rad what the camera sees to either
  /// side of its axis: what lies within and is not told is not seen
  void take(const base::Vision& vision, const base::Mount& mount, const Pose2& pose,
            double half_view_rad, const LandmarkParams& params, std::size_t eye = 0);
  void forget() noexcept {
    kept_.clear();
    stirs_.forget();
  }

  std::vector<Landmark> all() const;
  /// Those that are not known yet are counted from here on.
  void number_from(std::uint32_t first) noexcept { next_ = first; }

 private:
  struct Seen {
    Vec2 at{};  ///< in O
    double sigma_m = 0.1;
    double radius_m = 0.0;
    double slack_m = 0.0;  ///< of a scan's: so far beside its place it still stands
    std::string name;
  };
  /// Who saw it, and when.
  struct Look {
    bool by_vision = false;
    Eyes eye = 0;
    base::Time stamp;
    double moved_s = 0.0;
  };
  /// By whom it was ever told.
  struct Told {
    Eyes eye = 0;
    base::Time at;
    double unseen_s = 0.0;  ///< in its view
  };
  struct Kept {
    Landmark mark;
    double weight = 0.0;  ///< 1/m²
    int hits = 0;         ///< images
    int scans = 0;        ///< since it stands
    Standing stands{};
    bool wanders = false;  ///< said its last scan
    base::Time imaged_at{};
    std::vector<Told> told{};
    double moved_s = 0.0;     ///< when it was seen last
    base::Time scanned_at{};  ///< a scan told it last
    std::map<std::string, double> names;

    Told* by(Eyes eye) noexcept;
    double unseen_s() const noexcept;
    Eyes eyes() const noexcept;
    void add(const Kept& other);
  };
  void put(const std::vector<Seen>& seen, const Look& look, const LandmarkParams& params,
           std::vector<bool>& met);
  bool is_other(const Kept& kept, const Seen& seen, const Look& look) const noexcept;
  void believe(const PlanarScan& scan, const LandmarkParams& params);
  void move(const Pose2& pose, base::Time now) noexcept;
  static void join(Kept& kept, const Seen& seen, const Look& look, const LandmarkParams& params);

  std::vector<Kept> kept_;
  Slack slack_;
  Stirs stirs_;
  std::array<base::Time, 64> looked_at_{};  ///< by each sensor's number
  Pose2 stood_{};
  base::Time stood_at_{};
  double moved_s_ = 0.0;  ///< the body was under way so long
  std::uint32_t next_ = 1;
};

}  // namespace roverd::nav::marks
