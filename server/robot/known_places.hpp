#pragma once
// Things whose place was entered once, seen again: which one it is, and whether it may correct the
// estimate.
//
//   TagsSeen, marks::View ─which one?─▶ Estimator::compare ─fits─▶ correct: Used
//                              │             │          └─ satellites, map lead ─▶ Agrees
//                              │             └─ 5 looks and 0.5 s beside ─▶ distrusted, and told
//                              └─ a pole that may be another one ─▶ Ambiguous
//
//   distrusted ──5 looks that fit while the estimate is 3 times surer than it was off──▶ trusted
//
// A tag says by its number which one it is; one that an image shows twice is nobody. A pole is a
// known one only where no other known one lies within 5 sigma of what was predicted (1 m at least),
// and no other thing that stands alone was seen there.
//
// A robot that does not know where it is yet begins at the first tag that tells it (FirstSight).
//
// What contradicts is distrusted alone where satellites, a map, or what was believed before the
// last known place (20 to 1) speak against it. Else it is one word against another: both are
// distrusted and the estimate is as uncertain as they differ, until another one decides. Two that
// were distrusted alone and agree with each other are right: the robot was carried, or slipped.
//
// Control thread. Allocates when the list is set, and when something is told.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/known_place.hpp"
#include "nav/estimate/estimator.hpp"
#include "nav/marks/view.hpp"
#include "nav/sense/odometry.hpp"
#include "nav/tags/tag_place.hpp"
#include "robot/first_sight.hpp"

namespace roverd::robot {

class KnownPlaces {
 public:
  using List = std::shared_ptr<const std::vector<base::KnownPlace>>;

  /// From now on these; of those that stayed as they were what is known of them stays, too.
  /// @param list not null
  void set(List list);
  bool empty() const noexcept { return known_.empty(); }
  /// Once a tick, before what was seen. A state that is not newer is left out.
  void moved(const nav::sense::Odometry& now);
  void see(const nav::tags::TagsSeen& image, nav::Estimator& estimator, base::Time now);
  void see(const nav::marks::View& view, nav::Estimator& estimator, base::Time now);
  /// A person said where the robot stands: nothing is distrusted any more.
  void trust() noexcept;

  struct News {
    bool bad = true;
    std::string words;
  };
  /// What changed since it was asked last.
  std::vector<News> news();
  /// Null: there are none.
  std::shared_ptr<const std::vector<base::KnownPlaceState>> states();

 private:
  struct Known {
    base::KnownPlace place;
    std::uint32_t frame = 0;  ///< of `at`
    base::EnuPoint at{};
    base::PlaceVerdict verdict = base::PlaceVerdict::Unseen;
    std::string detail{};
    std::optional<base::Time> seen_at{};
    std::optional<base::Time> used_at{};
    double used_way_m = 0.0;    ///< way_m_ then
    double before_m = 0.0;      ///< 1 sigma of the estimate when it was used first this time
    base::EnuPoint moved{};     ///< so far it took the estimate since then
    nav::LandmarkLook look{};   ///< the last one
    double distrusted_m = 0.0;  ///< off by so much then; 0: it is trusted
    bool alone = false;         ///< distrusted alone
    base::EnuPoint off{};       ///< when it was
    base::Time since{};         ///< it is distrusted
    int beside = 0;             ///< looks in a row that do not fit
    base::Time beside_since{};
    int fits = 0;  ///< looks in a row that do, of one that is distrusted
  };
  /// One look at one of them.
  struct Seen {
    base::Time stamp;
    Eigen::Vector2d at;  ///< from the body then
    Eigen::Matrix2d covariance;
    std::optional<double> face_rad{};  ///< against the body's: in which the tag looks
    double face_sigma_rad = 0.0;
  };
  /// A post that was seen, and which known ones may be it.
  struct Post {
    Seen seen;
    std::vector<std::size_t> near{};
  };

  static bool is_far(const Known& known, const Seen& seen, const nav::Belief& b) noexcept;
  bool place_in(Known& known, const nav::Estimator& estimator) const;
  nav::LandmarkSight sight_of(const Known& known, const Seen& seen) const;
  std::vector<Post> posts_in(const nav::marks::View& view, const nav::Estimator& estimator,
                             base::Time now);
  void begin(Known& known, const Seen& seen, nav::Estimator& estimator, base::Time now);
  void judge(Known& known, const Seen& seen, nav::Estimator& estimator, base::Time now);
  void watch(Known& known, base::Time now);
  void contradicts(Known& known, nav::Estimator& estimator, base::Time now);
  void distrust(Known& known, base::Time now, base::PlaceVerdict verdict, std::string why);
  void put(Known& known, base::PlaceVerdict verdict);
  static bool outvoted(const Known& known, const Known& last) noexcept;
  Known* last_used(const Known& but, base::Time now) noexcept;
  Known* ally(const Known& known, base::Time now) noexcept;
  std::string source(const nav::Estimator& estimator, const Known* last) const;

  std::vector<Known> known_;
  nav::sense::PoseHistory history_;
  double way_m_ = 0.0;
  FirstSight first_sight_;
  std::map<std::uint32_t, base::Time> posts_taken_;  ///< by the landmark's id
  std::vector<News> news_;
  bool changed_ = true;
  std::shared_ptr<const std::vector<base::KnownPlaceState>> told_;
};

}  // namespace roverd::robot
