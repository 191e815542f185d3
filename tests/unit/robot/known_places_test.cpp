// Past tags and poles whose place is known: the estimate is corrected by them slowly and claims no
// more than it knows; one that was entered wrong is told, and not followed.
//
//   north ▲   |gate 20 m
//         │ o pole 12 m       the robot drives north, 1 m/s
//         │   |door 5 m
//         └──▶ east

#include "robot/known_places.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../nav/rails.hpp"
#include "nav/marks/scan.hpp"

namespace roverd::robot {
namespace {

using base::EnuPoint;
using base::KnownPlace;
using base::PlaceVerdict;

constexpr double kSeen_m = 5.0;
constexpr double kSeenByScan_m = 8.0;

/// Where it truly stands, and where somebody said that it does.
struct Thing {
  std::string name;
  EnuPoint truly;
  EnuPoint said;
  std::optional<int> tag{};
  bool faces = true;  ///< south, and that was entered
  double sigma_m = 0.03;
};

class Passing {
 public:
  explicit Passing(std::vector<Thing> things) : things_(std::move(things)) {
    d.gnss = d.compass = false;
    d.gyro = true;
    d.estimator.use_frame(frame_);
    auto list = std::make_shared<std::vector<KnownPlace>>();
    for (const Thing& t : things_) {
      KnownPlace k;
      k.name = t.name;
      k.at = frame_.to_global(t.said);
      k.sigma_m = t.sigma_m;
      k.tag = t.tag;
      if (t.tag && t.faces) k.yaw_rad = -base::kPi / 2.0;
      list->push_back(k);
    }
    known.set(list);
  }

  nav::Drive d;
  KnownPlaces known;
  std::vector<KnownPlaces::News> news;
  double farthest_m = 0.0;       ///< the estimate from the truth
  double fastest_mps = 0.0;      ///< the estimate beside the odometry, over a second
  double worst_sigmas = 0.0;     ///< the error, in claimed sigmas
  double odometry_scale = 1.03;  ///< of the frame in which a scan keeps its posts
  double range_sigma = 0.003;    ///< of a tag's range, for each m^2 of it

  /// A person says where it stands.
  void placed() {
    d.run(0.1);
    d.estimator.place(EnuPoint{0.0, 0.0}, base::kPi / 2.0);
  }
  void run(double seconds) {
    const int ticks = static_cast<int>(std::lround(seconds * 50.0));
    for (int i = 0; i < ticks; ++i) tick();
  }
  void forget() {
    fastest_mps = 0.0;
    off_.clear();
  }
  double sigma_m() const { return d.pose()->horizontal_sigma_m; }
  base::KnownPlaceState state(const std::string& name) {
    const auto all = known.states();
    return *std::ranges::find(*all, name, &base::KnownPlaceState::name);
  }
  PlaceVerdict verdict(const std::string& name) { return state(name).verdict; }

 private:
  void tick() {
    const auto before = d.pose();
    const double bend = d.rate_radps;
    d.tick();
    body_ = body_ * nav::sense::along(odometry_scale * d.speed_mps, bend, 0.02);
    known.moved({d.now(), body_, d.speed_mps, bend, {}});
    if (++count_ % 5 == 0) look();
    for (auto& one : known.news()) news.push_back(std::move(one));
    const auto now = d.pose();
    if (!before || !now || !now->heading_known) return;
    const double off_m = d.position_error_m();
    farthest_m = std::max(farthest_m, off_m);
    worst_sigmas = std::max(worst_sigmas, off_m / now->horizontal_sigma_m);
    off_.push_back({now->at.east_m - d.east_m, now->at.north_m - d.north_m});
    if (off_.size() > 51) off_.pop_front();
    if (off_.size() == 51) {
      fastest_mps = std::max(fastest_mps, base::distance_m(off_.front(), off_.back()));
    }
  }
  void look() {
    const nav::sense::Pose2 truly{d.east_m, d.north_m, d.yaw_rad};
    nav::tags::TagsSeen image{"front", d.now(), {}};
    nav::marks::View view;
    view.stamp = d.now();
    std::uint32_t id = 0;
    for (const Thing& t : things_) {
      ++id;
      const auto b =
          nav::marks::placed(nav::sense::inverse(truly), {t.truly.east_m, t.truly.north_m});
      const double range_m = std::hypot(b.x, b.y);
      const double ray_rad = std::atan2(b.y, b.x);
      if (t.tag && range_m < kSeen_m && range_m > 0.3 && std::abs(ray_rad) < 0.6) {
        nav::tags::TagPlace tag;
        tag.id = *t.tag;
        tag.pose = {b.x, b.y, base::angle_diff_rad(d.yaw_rad, base::kPi / 2.0)};
        tag.sigma_range_m = range_sigma * range_m * range_m;
        tag.sigma_across_m = 0.001 * range_m;
        tag.sigma_yaw_rad = 0.03;
        tag.yaw_known = range_m < 2.5;
        image.tags.push_back(tag);
      }
      if (!t.tag && range_m < kSeenByScan_m) {
        nav::marks::Landmark mark;
        mark.id = id;
        mark.at = nav::marks::placed(body_, b);
        mark.sigma_m = 0.02;
        mark.radius_m = 0.05;
        mark.by_scan = mark.believed = true;
        mark.seen_at = d.now();
        view.landmarks.push_back(mark);
      }
    }
    known.see(image, d.estimator, d.now());
    known.see(view, d.estimator, d.now());
  }

  std::vector<Thing> things_;
  base::LocalFrame frame_{7, nav::kOrigin};
  nav::sense::Pose2 body_{};
  std::deque<EnuPoint> off_;
  int count_ = 0;
};

Thing tag(std::string name, int id, EnuPoint at, EnuPoint wrong_by = {}) {
  return {std::move(name), at, at + wrong_by, id};
}
Thing pole(std::string name, EnuPoint at, EnuPoint wrong_by = {}) {
  return {std::move(name), at, at + wrong_by, std::nullopt};
}

std::vector<Thing> three_of_them(EnuPoint last_wrong_by = {}) {
  return {tag("door", 3, {0.8, 7.0}), pole("pole", {-1.0, 15.0}),
          tag("gate", 4, {0.8, 23.0}, last_wrong_by)};
}

TEST(KnownPlaces, KeepItWithinADecimetreOverThirtyMetresWithoutSatellites) {
  Passing p(three_of_them());
  p.d.slip = 0.95;  // the tracks count 5 % too much, more than was ever learned
  p.placed();
  p.d.speed_mps = 1.0;
  for (const double until_s : {7.0, 15.0, 23.0}) {  // beside each of them
    p.run(until_s - p.d.north_m);
    EXPECT_LT(p.d.position_error_m(), 0.12) << until_s;
    EXPECT_LT(p.sigma_m(), 0.2) << until_s;
  }
  p.run(7.0);
  EXPECT_EQ(p.verdict("door"), PlaceVerdict::Used);
  EXPECT_EQ(p.verdict("pole"), PlaceVerdict::Used);
  EXPECT_EQ(p.verdict("gate"), PlaceVerdict::Used);
  EXPECT_LT(p.farthest_m, 0.45);
  EXPECT_LT(p.worst_sigmas, 3.0) << "it claims no more than it knows";
  EXPECT_TRUE(p.news.empty());
  // By the odometry's own 0.05 and the corrections' 0.1.
  EXPECT_LT(p.fastest_mps, 0.16);
}

//   Switched on in the dark, two metres before a tag.
TEST(KnownPlaces, ATagTellsARobotThatKnowsNothingWhereItStands) {
  Passing p({tag("door", 3, {0.6, 2.2})});
  p.run(0.4);
  EXPECT_FALSE(p.d.pose()) << "one look, or two, may be wrong";
  p.run(1.0);
  ASSERT_TRUE(p.d.pose());
  EXPECT_TRUE(p.d.pose()->heading_known);
  EXPECT_LT(p.d.position_error_m(), 0.05);
  EXPECT_LT(std::abs(base::angle_diff_rad(p.d.yaw_rad, p.d.pose()->yaw_rad)), 0.03);
  EXPECT_LT(p.worst_sigmas, 2.0);
  EXPECT_GT(p.sigma_m(), 0.03) << "no better than the tag's own place";
  EXPECT_EQ(p.verdict("door"), PlaceVerdict::Used);
  ASSERT_EQ(p.news.size(), 1u);
  EXPECT_FALSE(p.news[0].bad);
  EXPECT_NE(p.news[0].words.find("known by door"), std::string::npos) << p.news[0].words;
}

TEST(KnownPlaces, ATagTellsItWhileItIsDrivenPastByHand) {
  Passing p({tag("door", 3, {0.6, 3.5})});
  p.d.speed_mps = 0.6;
  p.run(3.5);
  ASSERT_TRUE(p.d.pose());
  EXPECT_LT(p.d.position_error_m(), 0.12);
  EXPECT_LT(p.worst_sigmas, 3.0);
}

TEST(KnownPlaces, ATagWhoseFaceWasNotEnteredTellsNoFirstPlace) {
  Thing door = tag("door", 3, {0.6, 2.2});
  door.faces = false;
  Passing p({door});
  p.run(5.0);
  EXPECT_FALSE(p.d.pose());
  EXPECT_TRUE(p.news.empty());
}

TEST(KnownPlaces, APoleTellsNoFirstPlace) {
  Passing p({pole("pole", {0.6, 2.2})});
  p.run(5.0);
  EXPECT_FALSE(p.d.pose());
}

TEST(KnownPlaces, WithoutThemItWouldHaveBeenFarther) {
  Passing p({});
  p.d.slip = 0.95;
  p.placed();
  p.d.speed_mps = 1.0;
  p.run(30.0);
  EXPECT_GT(p.d.position_error_m(), 1.2);
}

TEST(KnownPlaces, OneThatWasEnteredAMetreWrongIsToldAndNotFollowed) {
  Passing p(three_of_them({0.0, 1.0}));
  p.d.slip = 0.95;
  p.placed();
  p.d.speed_mps = 1.0;
  p.run(30.0);
  EXPECT_EQ(p.verdict("gate"), PlaceVerdict::Contradicts);
  const auto gate = p.state("gate");
  EXPECT_NEAR(std::hypot(gate.off.east_m, gate.off.north_m), 1.0, 0.4);
  ASSERT_EQ(p.news.size(), 1u);
  EXPECT_NE(p.news[0].words.find("gate is seen"), std::string::npos) << p.news[0].words;
  EXPECT_NE(p.news[0].words.find("by pole, used"), std::string::npos) << p.news[0].words;
  EXPECT_LT(p.farthest_m, 0.9) << "the odometry's own error since the pole";
  EXPECT_LT(p.worst_sigmas, 3.0);
}

TEST(KnownPlaces, OneThatIsWrongIsToldAloneThoughTheOneBeforeItWasSeenFromAfarFirst) {
  // From 5 m a tag's range is 0.75 m uncertain; from beside it, it is not.
  Passing p({tag("door", 3, {0.8, 7.0}), tag("gate", 4, {0.8, 14.0}),
             tag("wrong", 5, {0.8, 21.0}, {0.0, 1.5})});
  p.d.slip = 0.99;
  p.range_sigma = 0.03;
  p.placed();
  p.d.speed_mps = 0.8;
  p.run(30.0);
  EXPECT_EQ(p.verdict("gate"), PlaceVerdict::Used);
  EXPECT_EQ(p.verdict("wrong"), PlaceVerdict::Contradicts) << p.state("wrong").detail;
  EXPECT_LT(p.worst_sigmas, 3.0);
}

TEST(KnownPlaces, NeverMoveItAwayFromFixedSatellites) {
  Passing p({tag("door", 3, {0.8, 7.0}, {1.0, 0.0}), tag("gate", 4, {0.8, 15.0})});
  p.d.gnss = p.d.compass = true;
  p.run(5.0);
  p.d.speed_mps = 1.0;
  p.run(20.0);
  EXPECT_LT(p.farthest_m, 0.05);
  EXPECT_EQ(p.verdict("door"), PlaceVerdict::Contradicts);
  EXPECT_EQ(p.verdict("gate"), PlaceVerdict::Agrees);
  ASSERT_EQ(p.news.size(), 1u);
  EXPECT_NE(p.news[0].words.find("1.0"), std::string::npos) << p.news[0].words;
  EXPECT_NE(p.news[0].words.find("by the satellites"), std::string::npos) << p.news[0].words;
}

TEST(KnownPlaces, ThatContradictEachOtherAreBothLeftUntilAThirdDecides) {
  // Nobody knows well where it stands: two tags before it, one of them wrong.
  Passing p({tag("door", 3, {0.8, 3.0}), tag("wall", 5, {-0.8, 3.5}, {0.0, 1.2}),
             tag("gate", 4, {0.8, 9.0})});
  p.placed();
  p.d.estimator.doubt_position(1.0);
  p.run(6.0);
  EXPECT_EQ(p.verdict("door"), PlaceVerdict::Disputed);
  EXPECT_EQ(p.verdict("wall"), PlaceVerdict::Disputed);
  ASSERT_EQ(p.news.size(), 1u);
  EXPECT_NE(p.news[0].words.find("contradict each other"), std::string::npos) << p.news[0].words;
  EXPECT_GT(p.sigma_m(), 0.8) << "what they differ by is in the claim";
  p.d.speed_mps = 0.3;
  p.run(20.0);  // past them, to the third
  p.d.speed_mps = 0.0;
  p.run(10.0);
  EXPECT_EQ(p.verdict("gate"), PlaceVerdict::Used);
  EXPECT_LT(p.d.position_error_m(), 0.15);
  EXPECT_LT(p.worst_sigmas, 3.0);
}

TEST(KnownPlaces, AgreeingTwoOfThemAreBelievedOfARobotThatWasCarried) {
  Passing p({tag("door", 3, {0.8, 3.0}), tag("gate", 4, {-0.8, 4.0})});
  p.placed();
  p.run(1.0);
  p.d.estimator.place(EnuPoint{1.5, 0.0}, base::kPi / 2.0);  // 1.5 m beside
  p.known.trust();
  p.forget();
  p.run(40.0);
  EXPECT_LT(p.d.position_error_m(), 0.1);
  EXPECT_LT(p.fastest_mps, 0.1);
}

TEST(KnownPlaces, PolesThatLookAlikeAreNotGuessed) {
  Passing p({pole("left", {-1.0, 4.0}), pole("right", {-0.2, 4.3})});
  p.placed();
  p.run(5.0);
  EXPECT_EQ(p.verdict("left"), PlaceVerdict::Ambiguous);
  EXPECT_EQ(p.verdict("right"), PlaceVerdict::Ambiguous);
  EXPECT_NE(p.state("left").detail.find("more than one"), std::string::npos);
  EXPECT_EQ(p.d.pose()->source, "odometry");
}

TEST(KnownPlaces, APoleFarFromWhereItIsKnownIsNoKnownOne) {
  Passing p({pole("pole", {-1.0, 4.0}, {0.0, 3.0})});
  p.placed();
  p.run(5.0);
  EXPECT_EQ(p.verdict("pole"), PlaceVerdict::Unseen);
  EXPECT_TRUE(p.news.empty());
}

TEST(KnownPlaces, NoNumberOfLooksMakesItSurerThanOneOfThemIsKnown) {
  std::vector<Thing> one{tag("door", 3, {0.5, 3.0})};
  one[0].sigma_m = 0.2;
  Passing p(one);
  p.placed();
  p.d.estimator.doubt_position(0.5);
  p.run(60.0);
  EXPECT_EQ(p.d.pose()->source, "landmark+odometry");
  EXPECT_GT(p.d.pose()->ellipse.minor_m, 0.19);
  EXPECT_LT(p.sigma_m(), 0.35);
}

TEST(KnownPlaces, ATagWithoutAKnownHeadingTellsOfThePlaceAlone) {
  std::vector<Thing> one{tag("door", 3, {0.5, 2.0})};
  one[0].faces = false;
  Passing p(one);
  p.placed();
  const double before = std::sqrt(p.d.estimator.belief().P(nav::kYaw, nav::kYaw));
  p.run(20.0);
  const double after = std::sqrt(p.d.estimator.belief().P(nav::kYaw, nav::kYaw));
  EXPECT_GT(after, 0.3 * before);
  one[0].faces = true;
  Passing q(one);
  q.placed();
  q.run(20.0);
  EXPECT_LT(std::sqrt(q.d.estimator.belief().P(nav::kYaw, nav::kYaw)), after);
  EXPECT_GT(std::sqrt(q.d.estimator.belief().P(nav::kYaw, nav::kYaw)), 0.02)
      << "the wall's heading is known no better";
}

TEST(KnownPlaces, WhenSatellitesComeBackBesideThemNothingJumps) {
  Passing p(three_of_them());
  p.d.offset_east_m = 0.4;  // what both differ by
  p.placed();
  p.d.speed_mps = 1.0;
  p.run(22.0);
  ASSERT_EQ(p.d.pose()->source, "landmark+odometry");
  p.forget();
  p.d.gnss = true;
  p.run(20.0);
  EXPECT_LT(p.fastest_mps, 0.12);
  EXPECT_NEAR(p.d.position_error_m(), 0.4, 0.05);  // they lead
}

}  // namespace
}  // namespace roverd::robot
