// What is not believed: counted by cause, never fused.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "rails.hpp"

namespace roverd::nav {
namespace {

using base::Refusal;
using std::chrono::milliseconds;

std::uint64_t count(const Drive& d, Refusal why) {
  return d.estimator.health().refusals[static_cast<std::size_t>(why)];
}

base::GnssFix fix_at(const Drive& d, base::LatLon at) {
  base::GnssFix f;
  f.stamp = d.now() + milliseconds(1);
  f.fix = base::FixType::RtkFixed;
  f.position = at;
  return f;
}

TEST(EstimatorRefusal, NamesWhatIsWrongWithAFixAndStaysWhereItIs) {
  Drive d;
  d.run(3.0);
  const auto told = [&](auto change, Refusal why) {
    const auto before = d.estimator.belief().x;
    const std::uint64_t n = count(d, why);
    base::GnssFix f = fix_at(d, {58.3780001, 26.729});
    change(f);
    d.estimator.take(f, d.now());
    EXPECT_EQ(count(d, why), n + 1) << base::to_string(why);
    EXPECT_EQ(before, d.estimator.belief().x) << base::to_string(why);
    d.tick();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  told([](auto& f) { f.position = base::LatLon{0.0, 0.0}; }, Refusal::Zero);
  told([&](auto& f) { f.position = base::LatLon{nan, 26.7}; }, Refusal::NotFinite);
  told([](auto& f) { f.position = base::LatLon{99.0, 26.7}; }, Refusal::Impossible);
  told([](auto& f) { f.satellites = 4; }, Refusal::Satellites);
  told([](auto& f) { f.hdop = 9.0; }, Refusal::Dilution);
  told([](auto& f) { f.sigma_east_m = 12.0; }, Refusal::Accuracy);
  told([](auto& f) { f.position = base::LatLon{58.3784, 26.729}; }, Refusal::Jump);
  told([](auto& f) { f.stamp += std::chrono::seconds(1); }, Refusal::Stamp);
  told([](auto& f) { f.stamp -= std::chrono::seconds(1); }, Refusal::Stamp);
  told([](auto& f) { f.utc = base::WallTime{std::chrono::seconds(315'964'800)}; }, Refusal::Date);
}

TEST(EstimatorRefusal, AReceiversClockThatGoesBackwardsIsNotBelievedAtOnce) {
  Arrival arrival;
  const base::WallTime wall{std::chrono::seconds(1'780'000'000)};
  Time now{};
  const auto late = [&](int epoch_ms, int latency_ms) {
    now = Time{milliseconds(epoch_ms + latency_ms)};
    return arrival.late_s(now, wall + milliseconds(epoch_ms));
  };
  EXPECT_NEAR(late(0, 120).value(), 0.0, 1e-6);
  EXPECT_NEAR(late(200, 120).value(), 0.0, 1e-3);
  EXPECT_NEAR(late(400, 180).value(), 0.06, 1e-3);  // 60 ms later than usual: older by as much
  EXPECT_FALSE(late(400, 190));                     // the same epoch again
  EXPECT_FALSE(late(300, 400));                     // an older one
  EXPECT_FALSE(late(800, 1200));                    // a second late
  EXPECT_NEAR(late(2200, 120).value(), 0.0, 1e-2);
  // A leap second, or a rolled week: after five epochs the new time counts.
  for (int i = 1; i <= 4; ++i) {
    EXPECT_FALSE(arrival.late_s(now + milliseconds(200 * i),
                                wall - std::chrono::hours(1) + milliseconds(200 * i)));
  }
  EXPECT_TRUE(
      arrival.late_s(now + milliseconds(1000), wall - std::chrono::hours(1) + milliseconds(1000)));
  EXPECT_EQ(Arrival{}.late_s(now, std::nullopt), 0.0);  // it tells no time
}

TEST(EstimatorRefusal, APositionThatIsOlderThanWhatIsRememberedIsNotFused) {
  Drive d;
  d.speed_mps = 1.0;
  d.run(10.0);
  d.gnss = false;
  d.run(4.0);
  const std::uint64_t before = count(d, Refusal::Stamp);
  const auto x = d.estimator.belief().x;
  base::GnssFix f = fix_at(d, d.pose()->global);
  f.stamp = d.now();
  f.latency_s = 3.9;  // 192 states of 20 ms are 3.84 s
  d.estimator.take(f, d.now());
  base::GnssVelocity v{d.now(), 0.0, 1.0, {}, 3.9};
  d.estimator.take(v, d.now());
  EXPECT_EQ(count(d, Refusal::Stamp), before + 2);
  EXPECT_EQ(x, d.estimator.belief().x);
}

TEST(EstimatorRefusal, TwoReceiversThatDisagreeAreNamedAndNoneIsFused) {
  Drive d;
  d.run(3.0);
  const auto at = d.pose()->at;
  const base::LocalFrame frame = *d.estimator.frame();
  d.gnss = false;
  for (int i = 0; i < 40; ++i) {
    d.run(0.1);
    const double east_m = i % 2 == 0 ? 0.0 : 50.0;
    d.estimator.take(fix_at(d, frame.to_global({at.east_m + east_m, at.north_m})), d.now());
  }
  EXPECT_TRUE(d.estimator.health().receivers_disagree);
  EXPECT_GT(count(d, Refusal::Receivers), 30u);
  EXPECT_LT(base::distance_m(d.pose()->at, at), 0.1);
  EXPECT_EQ(d.estimator.health().resets, 0u);
  // One of them alone is believed again after a while.
  d.gnss = true;
  d.run(6.0);
  EXPECT_FALSE(d.estimator.health().receivers_disagree);
  EXPECT_FALSE(d.estimator.health().position.refused_since);
}

TEST(EstimatorRefusal, AVelocityOfWhichTheReceiverIsNotSureIsNotUsed) {
  Drive d;
  d.run(3.0);
  d.estimator.take(base::GnssVelocity{d.now() + milliseconds(1), 5.0, 0.0, 2.0}, d.now());
  EXPECT_EQ(count(d, Refusal::Accuracy), 1u);
  EXPECT_EQ(d.estimator.health().velocity.rejected, 1u);
  d.estimator.take(base::GnssVelocity{d.now() + milliseconds(2), 500.0, 0.0, {}}, d.now());
  EXPECT_EQ(count(d, Refusal::Impossible), 1u);
}

TEST(EstimatorRefusal, AGyroThatSpinsBeyondReasonIsNotUsed) {
  Drive d;
  d.gyro = true;
  d.run(3.0);
  base::Inertial wild;
  wild.stamp = d.now() + milliseconds(1);
  wild.rate_radps = base::BodyVector{0.0, 0.0, 900.0};
  d.estimator.take(wild, d.now());
  EXPECT_EQ(d.estimator.health().inertial.rejected, 1u);
  EXPECT_LT(std::abs(d.pose()->yaw_rate_radps.value()), 0.01);
}

}  // namespace
}  // namespace roverd::nav
