#pragma once
// The tags that were seen, kept over time in the odometry's frame O.
//
//   image ─Finder─▶ TagsSeen ─stamp─▶ X_OB then ─▶ TagTrack of that id
//   tick ─▶ moved() ───────────────────▲
//
// Each is taken as hanging in the level plan, however the body leaned then (level()).
// Of an image that shows an id twice that id is left out: nobody knows which of the two is meant.
// One more than kMost takes the place of the one not seen for longest. Control thread; allocates
// only when a tag is seen for the first time.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "nav/sense/odometry.hpp"
#include "nav/tags/tag_place.hpp"
#include "nav/tags/tag_track.hpp"

namespace roverd::nav::tags {

/// One of them.
struct KnownTag {
  int id = 0;
  TagTrack track;
  std::uint64_t sights = 0;  ///< images that it was taken from
  std::string camera;        ///< that saw it last
};

class TagBook {
 public:
  static constexpr std::size_t kMost = 32;

  /// @return false: not newer, or not finite
  bool moved(const sense::Odometry& now) noexcept { return history_.push(now); }
  /// @return ids that were taken; the image's stamp lies too far back, or ahead: none
  std::size_t take(const TagsSeen& seen);

  /// Null: never seen.
  const KnownTag* find(int id) const noexcept;
  const std::vector<KnownTag>& all() const noexcept { return known_; }

  std::uint64_t images() const noexcept { return images_; }
  std::uint64_t refused() const noexcept { return refused_; }  ///< images of an unknown moment
  std::uint64_t twice() const noexcept { return twice_; }      ///< ids that an image showed twice
  /// When an image showed that id twice last, of the id that one did last. Empty: never.
  std::optional<base::Time> twice_at(int id) const noexcept {
    return id == twice_id_ ? std::optional(twice_at_) : std::nullopt;
  }
  /// When an image was taken that was looked through last; by any camera.
  base::Time looked_at() const noexcept { return looked_at_; }

 private:
  sense::PoseHistory history_;
  std::vector<KnownTag> known_;
  std::uint64_t images_ = 0;
  std::uint64_t refused_ = 0;
  std::uint64_t twice_ = 0;
  int twice_id_ = -1;
  base::Time twice_at_{};
  base::Time looked_at_{};
};

/// What is known of tags at one tick.
struct TagSight {
  const TagBook* book = nullptr;
  base::Time now;
  sense::Pose2 body;  ///< X_OB now
};

}  // namespace roverd::nav::tags
