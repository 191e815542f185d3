// A depth camera of the kernel, from its system calls to what was seen. The images are a real
// camera's; the calls are answered by a stand-in that does as the API's description says.

#include "v4l2/camera.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cloud/driver.hpp"
#include "stand_in.hpp"
#include "unit/cloud/png.hpp"
#include "unit/link/tools.hpp"

namespace roverd::v4l2 {
namespace {

using namespace std::chrono_literals;
using base::DriverPhase;
using link::run_until;

Params of_the_images() {
  Params p;
  p.fx = 525.0;
  return p;
}

/// The camera with the driver that hears it.
struct Seeing : ::testing::Test {
  void begin(const Params& params = of_the_images(), cloud::Params heard = {}) {
    heard.decimate = 1;
    heard.same_clock = true;
    heard.retry_first_s = 0.05;
    driver.emplace(
        "front", heard,
        [this, params]() -> base::Result<std::unique_ptr<link::ByteLink>> {
          return std::make_unique<Camera>(io, "/dev/video2", params, camera);
        },
        [](const base::Measurement&) {},
        [this](std::shared_ptr<const base::Sight> s) { sights.push_back(std::move(s)); });
    driver->start(base::steady_now());
  }
  bool until_sights(std::size_t n) {
    return run_until(io, [&] {
      driver->tick(base::steady_now());
      return sights.size() >= n;
    });
  }
  base::DriverStatus status() const { return driver->status(base::steady_now()); }
  std::uint64_t count(const std::string& what) const {
    const auto counts = status().detail->counts;
    return counts.contains(what) ? counts.at(what) : 0;
  }
  std::vector<std::uint16_t> flat(std::uint16_t depth) const {
    return std::vector<std::uint16_t>(std::size_t{camera.width} * camera.height, depth);
  }

  boost::asio::io_context io;
  StandIn camera;
  std::vector<std::shared_ptr<const base::Sight>> sights;
  std::optional<cloud::Driver> driver;
};

TEST_F(Seeing, RealDepthImagesBecomeThePointsThatAreExpected) {
  ROVERD_REAL_DATA(expected_path, "sensors/clouds/depth-expected.json");
  const auto expected = nlohmann::json::parse(std::ifstream(expected_path));
  begin();
  EXPECT_TRUE(camera.streams);
  EXPECT_EQ(camera.interval.numerator, 1U);
  EXPECT_EQ(camera.interval.denominator, 30U);
  for (const auto& [name, want] : expected.items()) {
    const auto image = cloud::png_of(expected_path.parent_path() / name);
    const base::Time measured = base::steady_now() - 40ms;
    ASSERT_TRUE(camera.show(image.pixels, V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC, measured));
    const std::size_t before = sights.size();
    ASSERT_TRUE(until_sights(before + 1));
    const base::Sight& sight = *sights.back();
    // When it was measured, as the kernel said: to the microsecond.
    EXPECT_LT(std::chrono::abs(sight.stamp - measured), 1us);
    ASSERT_EQ(sight.points.size(), 640U * 480U);
    double sum_m = 0.0;
    std::uint64_t hits = 0;
    for (const auto& p : sight.points) {
      if (p.echo != base::Echo::Hit) continue;
      ++hits;
      sum_m += p.x_m;
    }
    EXPECT_EQ(hits, want["valid"].get<std::uint64_t>());
    EXPECT_NEAR(sum_m, want["sum"].get<double>() / 1000.0, 0.5);
    for (const auto& pixel : want["pixels"]) {
      const auto& p =
          sight.points[pixel["v"].get<std::size_t>() * 640 + pixel["u"].get<std::size_t>()];
      EXPECT_NEAR(p.x_m, pixel["z_ahead"].get<double>(), 1e-4);
      EXPECT_NEAR(p.y_m, -pixel["x_right"].get<double>(), 1e-4);
      EXPECT_NEAR(p.z_m, -pixel["y_down"].get<double>(), 1e-4);
    }
  }
  EXPECT_EQ(status().phase, DriverPhase::Up);
  EXPECT_EQ(status().refused, 0U);
  EXPECT_EQ(status().link, "v4l2:/dev/video2");
  EXPECT_EQ(count("frames lost"), 0U);
  // Every buffer is with the driver again.
  EXPECT_EQ(camera.waiting_to_be_filled(), StandIn::kBuffers);
  driver->stop(base::steady_now());
  EXPECT_FALSE(camera.streams);
  EXPECT_EQ(camera.mapped, 0);
}

TEST_F(Seeing, RowsThatAreFilledUpAndOtherUnitsAreReadAsTheyAre) {
  camera.width = 16;
  camera.height = 16;
  camera.stride = 64;  // 32 bytes of pixels, 32 of nothing
  Params p = of_the_images();
  p.width = p.height = 16;
  p.fx = 100.0;
  p.fy = 50.0;
  p.cx = 3.0;
  p.cy = 5.0;
  p.depth_unit_m = 0.0001;
  begin(p);
  auto image = flat(0);
  image[std::size_t{7} * 16 + 13] = 0x4E20;  // 20000: 2 m
  ASSERT_TRUE(camera.show(image));
  ASSERT_TRUE(until_sights(1));
  const auto& at = sights[0]->points[std::size_t{7} * 16 + 13];
  EXPECT_EQ(at.echo, base::Echo::Hit);
  EXPECT_NEAR(at.x_m, 2.0, 1e-5);
  EXPECT_NEAR(at.y_m, -2.0 * (13 - 3) / 100.0, 1e-5);
  EXPECT_NEAR(at.z_m, -2.0 * (7 - 5) / 50.0, 1e-5);
  const auto others = std::ranges::count_if(
      sights[0]->points, [](const auto& point) { return point.echo == base::Echo::Hit; });
  EXPECT_EQ(others, 1);
  // A clock that is not ours tells nothing: the time of the taking.
  EXPECT_LT(base::steady_now() - sights[0]->stamp, 10s);
}

TEST_F(Seeing, DamagedAndShortImagesAreCountedAndGivenBack) {
  begin();
  ASSERT_TRUE(camera.show(flat(1000)));
  ASSERT_TRUE(until_sights(1));
  ASSERT_TRUE(camera.show(flat(900), V4L2_BUF_FLAG_ERROR));
  ASSERT_TRUE(camera.show(flat(900), 0, {}, 640 * 480 * 2 - 2));
  ASSERT_TRUE(camera.show(flat(2000)));
  ASSERT_TRUE(until_sights(2));
  EXPECT_EQ(sights.size(), 2U);
  EXPECT_NEAR(sights[1]->points[0].x_m, 2.0, 1e-5);
  EXPECT_EQ(count("image that the camera's driver marks as damaged"), 1U);
  EXPECT_EQ(count("image that is too short"), 1U);
  EXPECT_EQ(count("frames lost"), 2U);
  EXPECT_EQ(sights[1]->count, 3U) << "a gap where two are missing";
  EXPECT_EQ(status().refused, 2U);
  EXPECT_EQ(camera.waiting_to_be_filled(), StandIn::kBuffers);
}

TEST_F(Seeing, MoreImagesThanBuffersAreLostAndCountedByTheirNumbers) {
  begin();
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(camera.show(flat(1000)));
  EXPECT_FALSE(camera.show(flat(1000))) << "nobody took any";
  ASSERT_TRUE(until_sights(4));
  ASSERT_TRUE(camera.show(flat(1000)));
  ASSERT_TRUE(until_sights(5));
  EXPECT_EQ(count("frames lost"), 1U);
}

TEST_F(Seeing, ACameraThatIsPulledOutIsHeardAgainWhenItIsBack) {
  begin();
  ASSERT_TRUE(camera.show(flat(1000)));
  ASSERT_TRUE(until_sights(1));
  camera.pull();
  ASSERT_TRUE(run_until(io, [&] {
    driver->tick(base::steady_now());
    return status().phase == DriverPhase::Faulty;
  }));
  EXPECT_EQ(status().reason, "lost v4l2:/dev/video2: No such device");
  EXPECT_EQ(camera.mapped, 0);
  ASSERT_TRUE(run_until(io, [&] {
    driver->tick(base::steady_now());
    return status().reason.find("cannot be opened") != std::string::npos;
  }));
  EXPECT_EQ(status().reason, "camera /dev/video2 cannot be opened: No such file or directory");
  camera.there = true;
  ASSERT_TRUE(run_until(io, [&] {
    driver->tick(base::steady_now());
    return camera.streams;
  }));
  EXPECT_EQ(camera.opened, 2);
  ASSERT_TRUE(camera.show(flat(3000)));
  ASSERT_TRUE(until_sights(2));
  EXPECT_EQ(status().phase, DriverPhase::Up);
}

TEST_F(Seeing, ASilentCameraIsOpenedAgain) {
  cloud::Params heard;
  heard.silent_after_s = 0.1;
  heard.silent_reopen_s = 0.2;
  begin(of_the_images(), heard);
  ASSERT_TRUE(run_until(io, [&] {
    driver->tick(base::steady_now());
    return camera.opened >= 2;
  }));
  ASSERT_TRUE(run_until(io, [&] {
    driver->tick(base::steady_now());
    return camera.streams;
  }));
  ASSERT_TRUE(camera.show(flat(1000)));
  EXPECT_TRUE(until_sights(1));
}

/// Why it does not open.
std::string refused(StandIn& camera, Params params = of_the_images()) {
  boost::asio::io_context io;
  Camera link(io, "/dev/video2", params, camera);
  const auto opened = link.open();
  EXPECT_EQ(camera.mapped, opened ? 4 : 0);
  EXPECT_EQ(camera.streams, opened.has_value());
  return opened ? "taken" : opened.error().detail;
}

TEST(V4l2Camera, WhatIsNoDepthCameraIsRefusedWithTheReason) {
  StandIn gone;
  gone.there = false;
  EXPECT_EQ(refused(gone), "camera /dev/video2 cannot be opened: No such file or directory");
  StandIn metadata;
  metadata.node = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  EXPECT_EQ(refused(metadata),
            "camera /dev/video2 gives no images: another node of the device may");
  StandIn by_reading;
  by_reading.node = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_READWRITE;
  EXPECT_EQ(refused(by_reading), "camera /dev/video2 cannot give its images by shared memory");
  StandIn colour;
  colour.formats = {V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_Y8I};
  EXPECT_EQ(refused(colour),
            "camera /dev/video2 gives no depth (Z16), only YUYV, Y8I: another node of the device "
            "may");
  StandIn small;
  small.width = 424;
  small.height = 240;
  EXPECT_EQ(refused(small), "camera /dev/video2 gives Z16 424x240 instead of Z16 640x480");
  StandIn busy;
  busy.busy = true;
  EXPECT_EQ(refused(busy),
            "camera /dev/video2 cannot be set to depth (Z16): Device or resource busy");
}

TEST(V4l2Camera, TheKernelsOwnCallsTellOfADeviceThatThereIsNot) {
  boost::asio::io_context io;
  Camera none(io, "/dev/video-that-there-is-not", of_the_images());
  EXPECT_NE(none.open().error().detail.find("No such file or directory"), std::string::npos);
  Camera null(io, "/dev/null", of_the_images());  // answers no ioctl of a camera
  EXPECT_EQ(null.open().error().detail,
            "camera /dev/null is no camera: Inappropriate ioctl for device");
}

TEST(V4l2Camera, SettingsWithoutAFocalLengthAreRefused) {
  EXPECT_EQ(validate(Params{}).error().fields[0].pointer, "fx");
  Params p = of_the_images();
  EXPECT_TRUE(validate(p));
  p.cy = 481.0;
  EXPECT_EQ(validate(p).error().fields[0].pointer, "cy");
  EXPECT_EQ(path_of("v4l2:/dev/video2"), "/dev/video2");
  EXPECT_EQ(path_of("tcp:a:1"), "");
}

}  // namespace
}  // namespace roverd::v4l2
