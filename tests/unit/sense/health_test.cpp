// Can a sensor be relied on.
#include "nav/sense/health.hpp"

#include <gtest/gtest.h>

#include "scene.hpp"

namespace roverd::nav::sense {
namespace {

struct Watched {
  HealthWatch watch{{}, at(0.0)};
  base::Sight sight;
  Counts counts{.points = 100, .kept = 90, .unknown = 10};
  double t = 0.0;

  void pieces(int n, double every_s) {
    for (int i = 0; i < n; ++i, ++sight.count) watch.took(sight, counts, at(t += every_s));
  }
  Fitness after(double s) const { return watch.at(at(t + s)); }
};

TEST(HealthTest, TenPiecesASecondAreFineAndSilenceIsBlindWithinThreeTenths) {
  Watched w;
  EXPECT_EQ(w.after(0.1).eye, Eye::Ok) << "it may still begin";
  EXPECT_EQ(w.after(0.31).eye, Eye::Blind);
  EXPECT_EQ(w.after(0.31).reason, "it has told nothing yet");
  w.pieces(20, 0.1);
  EXPECT_EQ(w.after(0.05).eye, Eye::Ok);
  EXPECT_NEAR(w.after(0.0).rate_hz, 10.0, 0.01);
  EXPECT_EQ(w.after(0.29).eye, Eye::Ok);
  EXPECT_EQ(w.after(0.31).eye, Eye::Blind);
  EXPECT_EQ(w.after(0.31).reason, "it is silent");
}

TEST(HealthTest, HalfItsRateIsDegraded) {
  Watched w;
  w.pieces(20, 0.2);
  EXPECT_EQ(w.after(0.0).eye, Eye::Degraded);
  EXPECT_EQ(w.after(0.0).reason, "it is slow");
}

TEST(HealthTest, UnknownDirectionsDegradeAndThenBlindIt) {
  Watched w;
  w.counts = {.points = 100, .kept = 70, .unknown = 30};
  w.pieces(5, 0.1);
  EXPECT_EQ(w.after(0.0).eye, Eye::Degraded);
  w.counts = {.points = 100, .kept = 40, .unknown = 60};
  w.pieces(1, 0.1);
  EXPECT_EQ(w.after(0.0).eye, Eye::Blind);
  EXPECT_NEAR(w.after(0.0).unknown_part, 0.6, 1e-12);
  w.counts = {};
  w.pieces(1, 0.1);
  EXPECT_EQ(w.after(0.0).eye, Eye::Blind) << "a piece of no points tells nothing";
}

TEST(HealthTest, TheWindowSpeaksForItself) {
  Watched w;
  w.sight.window = base::Window::Dirty;
  w.pieces(5, 0.1);
  EXPECT_EQ(w.after(0.0).reason, "its window is dirty");
  w.sight.window = base::Window::Blocked;
  w.pieces(1, 0.1);
  EXPECT_EQ(w.after(0.0).eye, Eye::Blind);
  EXPECT_EQ(w.after(0.0).reason, "its window is blocked");
}

TEST(HealthTest, PiecesThatAreLostOrOfNoUseAreCountedAndDoNotKeepItAlive) {
  Watched w;
  w.pieces(5, 0.1);
  w.sight.count += 3;
  w.pieces(1, 0.1);
  EXPECT_EQ(w.after(0.0).lost, 3U);
  w.sight.good = false;
  w.pieces(4, 0.1);
  EXPECT_EQ(w.after(0.0).refused, 4U);
  EXPECT_EQ(w.after(0.0).eye, Eye::Blind);
}

}  // namespace
}  // namespace roverd::nav::sense
