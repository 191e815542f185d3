// Two cameras on real ports, one of them malformed.

#include "vision/driver.hpp"

#include <memory>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "link/memory.hpp"
#include "link/udp.hpp"
#include "unit/link/pump.hpp"

namespace roverd::vision {
namespace {

using namespace std::chrono_literals;
using base::DriverPhase;
using Seen = std::vector<std::shared_ptr<const base::Vision>>;

base::Bytes bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

struct VisionOnWire : ::testing::Test {
  VisionOnWire() {
    EXPECT_TRUE(wire.b->open());
    driver.start(now);
  }
  void say(std::string_view text) {
    wire.b->write(bytes_of(text));
    ours->deliver(now);
    driver.tick(now);
  }
  std::uint64_t counted(const std::string& cause) const {
    const auto counts = driver.status(now).detail->counts;
    return counts.contains(cause) ? counts.at(cause) : 0;
  }
  std::string fact(const std::string& key) const {
    const auto facts = driver.status(now).detail->facts;
    return facts.contains(key) ? facts.at(key) : "";
  }

  Time now{std::chrono::hours(1)};
  link::MemoryBytePair wire = link::memory_byte_pair();
  link::MemoryByteLink* ours = wire.a.get();
  Seen seen;
  Params params;
  Driver driver{"front", params,
                [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire.a)); },
                [](const base::Measurement&) {},
                [this](std::shared_ptr<const base::Vision> v) { seen.push_back(std::move(v)); }};
};

TEST_F(VisionOnWire, ADatagramTellsWhatWasSeenWhenTheImageWasTaken) {
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Opening);
  say("cone: 0: 0.5 0.1 2: 1 0 2::");
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Up);
  EXPECT_EQ(seen[0]->sensor, "front");
  EXPECT_EQ(seen[0]->stamp, now - 100ms) << "latency_s";
  EXPECT_EQ(seen[0]->landmarks.at(0).name, "cone");
  EXPECT_EQ(fact("landmarks"), "1");
  EXPECT_EQ(fact("obstacles"), "1");
  EXPECT_EQ(fact("planes"), "0");
}

TEST_F(VisionOnWire, AnImageOfNothingIsASignOfLife) {
  say(":::::");
  say("cone#box:::::");
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_EQ(seen[1]->count, 1U);
  EXPECT_TRUE(seen[1]->landmarks.empty());
}

TEST_F(VisionOnWire, MalformedDatagramsAreCountedByCauseAndAreNoSignOfLife) {
  say("hello");
  say("cone: 0: 0.5 0.1:::");
  say("cone: 0: 0.5 0.1:::");
  EXPECT_TRUE(seen.empty());
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Opening);
  EXPECT_EQ(driver.status(now).refused, 3U);
  EXPECT_EQ(driver.status(now).received, 0U);
  EXPECT_EQ(counted("not six fields between colons"), 1U);
  EXPECT_EQ(counted("not three numbers for each landmark"), 2U);
  EXPECT_EQ(fact("refused_last"),
            "not three numbers for each landmark: field 2 (landmarks), byte 16");
}

TEST_F(VisionOnWire, SilenceIsAFaultAndSaysOfWhichKind) {
  say(":::::");
  now += 2100ms;
  driver.tick(now);
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Faulty);
  EXPECT_EQ(driver.status(now).reason, "nothing of the vision program");
  say(":::::");
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Up);
  now += 2100ms;
  say("what?");
  EXPECT_EQ(driver.status(now).phase, DriverPhase::Faulty);
  EXPECT_EQ(driver.status(now).reason, "what the vision program sends is malformed");
}

TEST(VisionDriver, TwoCamerasHaveAPortEach) {
  boost::asio::io_context io;
  struct Camera {
    Seen seen;
    link::UdpLink* port = nullptr;
    std::unique_ptr<Driver> driver;
  };
  Camera front;
  Camera side;
  const auto open = [&io](Camera& c, const char* name) {
    c.driver = std::make_unique<Driver>(
        name, Params{},
        [&]() -> base::Result<std::unique_ptr<link::ByteLink>> {
          auto made = std::make_unique<link::UdpLink>(io, 0);
          c.port = made.get();
          return made;
        },
        [](const base::Measurement&) {},
        [&c](std::shared_ptr<const base::Vision> v) { c.seen.push_back(std::move(v)); });
    c.driver->start(base::steady_now());
  };
  open(front, "front");
  open(side, "side");
  link::UdpLink to_front(io, 0, link::UdpLink::Peer{"127.0.0.1", front.port->port()});
  link::UdpLink to_side(io, 0, link::UdpLink::Peer{"127.0.0.1", side.port->port()});
  ASSERT_TRUE(to_front.open());
  ASSERT_TRUE(to_side.open());
  to_front.write(bytes_of("cone: 0: 0 0 2:::"));
  to_side.write(bytes_of(":::: 0 0 0.9 0 0 -1: 5000"));
  link::Pump<Driver> pump(io, *front.driver);
  ASSERT_TRUE(pump.until([&] { return !front.seen.empty() && !side.seen.empty(); }));
  EXPECT_EQ(front.seen.at(0)->landmarks.size(), 1U);
  EXPECT_EQ(side.seen.at(0)->sensor, "side");
  EXPECT_EQ(side.seen.at(0)->planes.size(), 1U);
}

}  // namespace
}  // namespace roverd::vision
