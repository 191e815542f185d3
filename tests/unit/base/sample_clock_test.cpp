#include "base/sample_clock.hpp"

#include <gtest/gtest.h>

namespace roverd::base {
namespace {

using Clock = SampleClock<100>;

/// A device of 100 Hz whose link takes 3 ms, 9 ms for every other sample.
struct Device {
  Clock clock;
  double true_s = 50.0;  ///< our clock, when the sample was taken
  double stood_s = 0.0;  ///< its own clock did not run for so long, all in all
  int n = 0;

  /// @param late_s the link's delay beyond the usual. @return how far the stamp is off, late
  /// positive
  double sample(double late_s = 0.0) {
    true_s += 0.01;
    const auto count = static_cast<std::uint32_t>(std::llround((true_s - stood_s) * 1e4));
    const double link_s = (n++ % 2 == 0 ? 0.003 : 0.009) + late_s;
    const auto read = clock.read(count, Time{from_seconds(true_s + link_s)});
    return seconds(read.stamp.time_since_epoch()) - true_s;
  }
  double after(double seconds_on, double late_s = 0.0) {
    double off_s = 0.0;
    for (int i = 0; i < static_cast<int>(seconds_on * 100.0); ++i) off_s = sample(late_s);
    return off_s;
  }
};

TEST(SampleClock, ADeviceWhoseClockStoodStillIsBelievedAgain) {
  for (const double stood_s : {0.05, 0.3, 0.45, 3.0}) {
    // Given a device that is understood,
    Device device;
    EXPECT_NEAR(device.after(5.0), 0.003, 0.0005);
    // when its clock stands still for a moment,
    device.stood_s = stood_s;
    device.true_s += stood_s;
    // then its samples are of now again soon, and not that old for ever.
    EXPECT_NEAR(device.after(4.2), 0.003, 0.0005) << stood_s;
  }
}

TEST(SampleClock, ALinkThatIsSlowForAMomentMovesNoStamp) {
  // Given a device that is understood,
  Device device;
  device.after(5.0);
  // when its bytes come 0.2 s late for a second and a half,
  for (int i = 0; i < 150; ++i) {
    // then each stamp still tells when it was measured.
    EXPECT_NEAR(device.sample(0.2), 0.003, 0.001);
  }
  EXPECT_NEAR(device.after(5.0), 0.003, 0.001);
}

TEST(SampleClock, StampsNeverLieAfterTheArrival) {
  Device device;
  for (int i = 0; i < 3000; ++i) {
    if (i == 1000) device.stood_s += 0.4, device.true_s += 0.4;
    const double late_s = i % 700 > 650 ? 0.3 : 0.0;
    EXPECT_LE(device.sample(late_s), 0.0091 + late_s);
  }
}

}  // namespace
}  // namespace roverd::base
