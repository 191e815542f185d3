// The driver on a memory link, and the example of the documentation over a real port.

#include "cloud/driver.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "frames.hpp"
#include "link/memory.hpp"
#include "link/tcp.hpp"
#include "source_folder.hpp"
#include "unit/link/pump.hpp"

namespace roverd::cloud {
namespace {

using namespace std::chrono_literals;
using base::DriverPhase;

struct OnWire : ::testing::Test {
  explicit OnWire(const Params& params = {}) : params_(params) {
    EXPECT_TRUE(wire.b->open());
    driver.start(now);
  }
  void send(const Blob& frame) {
    wire.b->write(frame);
    ours->deliver(now);
  }
  std::uint64_t counted(const std::string& what) const {
    const auto counts = driver.status(now).detail->counts;
    return counts.contains(what) ? counts.at(what) : 0;
  }
  std::string fact(const std::string& key) const {
    return driver.status(now).detail->facts.at(key);
  }

  const Params params_;
  Time now{std::chrono::hours(1)};
  link::MemoryBytePair wire = link::memory_byte_pair();
  link::MemoryByteLink* ours = wire.a.get();
  std::vector<std::shared_ptr<const base::Sight>> sights;
  Driver driver{"camera", params_,
                [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire.a)); },
                [](const base::Measurement&) {},
                [this](std::shared_ptr<const base::Sight> s) { sights.push_back(std::move(s)); }};
};

TEST_F(OnWire, AFrameIsToldAtOnceAndItsSilenceIsAFault) {
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Opening);
  send(depth_frame(header_of(1), 4, std::vector<std::uint16_t>{1000, 0, 0, 0}));
  ASSERT_EQ(sights.size(), 1U);
  EXPECT_EQ(sights[0]->sensor, "camera");
  EXPECT_EQ(sights[0]->points.size(), 2U);
  EXPECT_EQ(sights[0]->stamp, now);
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Up);
  EXPECT_EQ(fact("frame"), "depth image 4x1");
  EXPECT_EQ(fact("missing_pct"), "50.0");
  now += 310ms;
  driver.tick(now);
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Faulty);
  EXPECT_EQ(driver.status(now).reason, "no frame");
  send(cloud_frame(header_of(2, 1'310'000'000), {}));
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Up);
  EXPECT_EQ(fact("missing_pct"), "100.0") << "a cloud of no point sees nothing";
}

TEST_F(OnWire, WhatHadToWaitIsStampedAsItWasMeasured) {
  const Time first = now;
  for (std::uint32_t i = 0; i < 10; ++i) {
    const bool late = i == 5;
    now = first + i * 50ms + (late ? 30ms : 0ms);
    send(cloud_frame(header_of(i, 7'000'000'000 + i * 50'000'000), {1.0F, 0.0F, 0.0F}));
  }
  ASSERT_EQ(sights.size(), 10U);
  EXPECT_NEAR(base::seconds(sights[5]->stamp - first), 0.25, 1e-4);
}

TEST_F(OnWire, APoseThatPutsTheCameraIntoTheGroundIsRefused) {
  // Given a mount 0.5 m above the ground,
  Header low = header_of(1);
  low.pose = base::Mount{.x_m = 0.2, .z_m = -0.6};
  send(cloud_frame(low, {1.0F, 0.0F, 0.0F}));
  EXPECT_TRUE(sights.empty());
  EXPECT_EQ(counted("a pose that puts the camera into the ground"), 1U);
  EXPECT_EQ(driver.status(now).detail->refused_last, "a pose that puts the camera into the ground");
  // when it stands on it by 10 cm, or higher than its mount, then it is heard.
  low.sequence = 2;
  low.pose->z_m = -0.4;
  send(cloud_frame(low, {1.0F, 0.0F, 0.0F}));
  low.sequence = 3;
  low.pose->z_m = 0.4;
  send(cloud_frame(low, {1.0F, 0.0F, 0.0F}));
  EXPECT_EQ(sights.size(), 2U);
}

TEST_F(OnWire, LostRepeatedAndRestartedSendersAreTold) {
  send(cloud_frame(header_of(10, 1'000), {}));
  send(cloud_frame(header_of(10, 1'000), {}));
  send(cloud_frame(header_of(14, 50'000'000), {}));
  EXPECT_EQ(counted("a frame twice"), 1U);
  EXPECT_EQ(counted("frames lost"), 3U);
  EXPECT_EQ(driver.status(now).detail->lost, 3U);
  EXPECT_EQ(driver.status(now).detail->twice, 1U);
  EXPECT_EQ(driver.status(now).refused, 0U) << "nothing was wrong with it";
  EXPECT_EQ(driver.status(now).detail->refused_last, "");
  ASSERT_EQ(sights.size(), 2U);
  EXPECT_EQ(sights[1]->count, 4U) << "the gap shows";
  send(cloud_frame(header_of(0, 0), {}));  // began anew
  EXPECT_EQ(counted("stamps that go back"), 1U);
  EXPECT_EQ(counted("frames lost"), 3U);
  EXPECT_EQ(sights.back()->count, 5U);
  EXPECT_EQ(sights.back()->stamp, now);
  // Clocks at their ends.
  send(cloud_frame(header_of(1, 4'000'000'000'000'000'000), {}));
  send(cloud_frame(header_of(2, 0), {}));
  EXPECT_EQ(sights.back()->stamp, now);
}

TEST_F(OnWire, RefusedFramesAreCountedByCauseAndNotHeard) {
  send(depth_frame(header_of(1), 1, {1000}, 0.5F));
  send({1, 2, 3, 4, 5});
  EXPECT_TRUE(sights.empty());
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Opening);
  EXPECT_EQ(counted("fx and fy of a depth image must be 1 or more"), 1U);
  EXPECT_EQ(counted("bytes outside any frame"), 5U);
}

TEST_F(OnWire, AFrameThatComesSlowerThanSilenceIsLetByWhole) {
  // Given a frame of more points than are taken, its sender slow: it is silent by now,
  send(cloud_frame(header_of(1), {1.0F, 0.0F, 0.0F}));
  const Blob large = cloud_frame(header_of(2, 1'050'000'000), std::vector<float>(3'600'000, 1.0F));
  const std::size_t piece = large.size() / 8;
  for (std::size_t at = 0; at < large.size(); at += piece) {
    now += 100ms;
    driver.tick(now);
    send({large.begin() + static_cast<std::ptrdiff_t>(at),
          large.begin() + static_cast<std::ptrdiff_t>(std::min(at + piece, large.size()))});
  }
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Faulty);
  // when the next one comes, then it is used, and of the large one nothing was taken for another.
  send(cloud_frame(header_of(3, 2'000'000'000), {1.0F, 0.0F, 0.0F}));
  EXPECT_EQ(sights.size(), 2U);
  EXPECT_EQ(driver.status(now).refused, 1U);
  EXPECT_EQ(counted("more than 1000000 points"), 1U);
}

/// What a camera that ends in the middle of a frame has sent of it.
Blob half_a_frame(std::size_t points) {
  const Blob whole = cloud_frame(header_of(1), std::vector<float>(3 * points, 1.0F));
  return {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(whole.size() / 2)};
}

TEST_F(OnWire, APauseWithinAFrameLosesNothing) {
  const Blob first = half_a_frame(10'000);
  const Blob whole = cloud_frame(header_of(1), std::vector<float>(30'000, 1.0F));
  send(first);
  for (int i = 0; i < 20; ++i) driver.tick(now += 100ms);
  send({whole.begin() + static_cast<std::ptrdiff_t>(first.size()), whole.end()});
  EXPECT_EQ(sights.size(), 1U);
  EXPECT_EQ(driver.status(now).refused, 0U);
}

TEST_F(OnWire, AnotherPeerBeginsAnewAtOnce) {
  for (const std::uint32_t points : {10'000U, 1'200'000U}) {  // one to be used, one to be let by
    sights.clear();
    send(half_a_frame(points));
    ours->on_peer();
    send(cloud_frame(header_of(points), {1.0F, 0.0F, 0.0F}));
    EXPECT_EQ(sights.size(), 1U) << points;
  }
}

/// Its link is never opened again for its silence: as in a replay.
struct OnPatientWire : OnWire {
  OnPatientWire()
      : OnWire([] {
          Params p;
          p.silent_reopen_s = 0.0;
          return p;
        }()) {}
};

TEST_F(OnPatientWire, WhereNobodyTellsOfItACutFrameSwallowsFiveSeconds) {
  send(half_a_frame(900'000));
  std::uint32_t n = 2;
  for (; sights.empty() && n < 200; ++n) {
    now += 50ms;
    driver.tick(now);
    send(cloud_frame(header_of(n, 1'000'000'000 + n * 50'000'000LL), {1.0F, 0.0F, 0.0F}));
  }
  EXPECT_NEAR(n * 0.05, 5.1, 0.1);
}

TEST_F(OnWire, AClosedLinkEndsTheFrame) {
  send(half_a_frame(10'000));
  driver.restart(now);
  send(cloud_frame(header_of(2, 2'000'000'000), {1.0F, 0.0F, 0.0F}));
  EXPECT_EQ(sights.size(), 1U);
}

/// A camera's program, run as a process.
class Sender {
 public:
  Sender(const std::string& script, std::uint16_t port, const std::string& images) {
    std::string port_text = std::to_string(port);
    std::string path = script;
    std::string host = "127.0.0.1";
    std::string count = images;
    std::string python = "python3";
    std::array<char*, 6> args{python.data(),    path.data(),  host.data(),
                              port_text.data(), count.data(), nullptr};
    EXPECT_EQ(::posix_spawnp(&pid_, "python3", nullptr, nullptr, args.data(), environ), 0);
  }
  ~Sender() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

 private:
  pid_t pid_ = 0;
};

TEST(CloudExample, TheSenderOfTheDocumentationIsUnderstood) {
  boost::asio::io_context io;
  link::TcpServer* port = nullptr;
  std::vector<std::shared_ptr<const base::Sight>> sights;
  Params params;
  params.silent_after_s = 10.0;  // the machine may be busy
  Driver driver(
      "camera", params,
      [&]() -> base::Result<std::unique_ptr<link::ByteLink>> {
        auto made = std::make_unique<link::TcpServer>(io, "127.0.0.1", 0, 1);
        port = made.get();
        return made;
      },
      [](const base::Measurement&) {},
      [&](std::shared_ptr<const base::Sight> s) { sights.push_back(std::move(s)); });
  driver.start(base::steady_now());
  ASSERT_NE(port, nullptr);
  const Sender sender(tests::in_source("docs/examples/cloud_sender.py"), port->port(), "3");
  link::Pump<Driver> pump(io, driver);
  ASSERT_TRUE(pump.until([&] { return sights.size() == 3; }));
  EXPECT_EQ(pump.status().refused, 0U);
  EXPECT_EQ(sights[2]->count, 2U);
  EXPECT_GT(base::seconds(sights[2]->stamp - sights[0]->stamp), 0.19);
  const auto& points = sights[0]->points;
  ASSERT_EQ(points.size(), 80U * 60U) << "one for each square of two by two pixels";
  // The wall at the left edge, the post in the middle, as the script draws them.
  const auto& wall = points[30 * 80];
  EXPECT_NEAR(wall.x_m, 3.0, 1e-5);
  EXPECT_NEAR(wall.y_m, 3.0 * 79.5 / 131.25, 1e-5);
  EXPECT_NEAR(points[30 * 80 + 40].x_m, 1.5, 1e-5);
}

}  // namespace
}  // namespace roverd::cloud
