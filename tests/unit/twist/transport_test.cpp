// The twist board at a pseudo-terminal and behind UDP.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "device_example.hpp"
#include "link/serial.hpp"
#include "link/udp.hpp"
#include "twist/driver.hpp"
#include "unit/link/pump.hpp"
#include "unit/link/terminal.hpp"

namespace roverd::twist {
namespace {

using base::DriverPhase;

/// What the board would say next.
std::string said_by(TwistDevice& device, base::Time now) {
  char out[160];
  const auto ms = static_cast<std::uint32_t>(base::seconds(now.time_since_epoch()) * 1e3);
  const int n = device.loop(ms, out, sizeof out);
  return n > 0 ? std::string(out, static_cast<std::size_t>(n)) : std::string();
}
void hear(TwistDevice& device, const std::string& text, base::Time now) {
  const auto ms = static_cast<std::uint32_t>(base::seconds(now.time_since_epoch()) * 1e3);
  for (const char c : text) device.byte_in(c, ms);
}

Params quick() {
  Params p;
  p.retry_first_s = p.retry_max_s = 0.05;
  return p;
}

struct BoardAtTerminal : ::testing::Test {
  void start() {
    driver = std::make_unique<Driver>(
        "twist", quick(),
        [this]() -> base::Result<std::unique_ptr<link::ByteLink>> {
          return std::make_unique<link::SerialLink>(io, terminal.path, 115200);
        },
        [this](const base::Measurement& m) {
          if (const auto* b = std::get_if<base::BaseMotion>(&m)) measured.push_back(*b);
        });
    driver->start(base::steady_now());
    pump = std::make_unique<link::Pump<Driver>>(io, *driver);
  }
  template <class Done>
  bool with_device_until(Done done) {
    return pump->until([&] {
      hear(device, terminal.hear(), base::steady_now());
      const std::string line = said_by(device, base::steady_now());
      if (!line.empty()) terminal.say(line);
      return done();
    });
  }
  bool is(DriverPhase phase) const { return pump->status().phase == phase; }

  boost::asio::io_context io;
  link::Terminal terminal;
  TwistDevice device;
  std::vector<base::BaseMotion> measured;
  std::unique_ptr<Driver> driver;
  std::unique_ptr<link::Pump<Driver>> pump;
};

TEST_F(BoardAtTerminal, DrivesOverTheSerialLineAndStopsWithoutCommands) {
  start();
  pump->command = base::DriveCommand{{0.4, 0.2}, true};
  ASSERT_TRUE(with_device_until([&] { return std::abs(device.speed_mps - 0.4F) < 1e-3F; }));
  EXPECT_TRUE(is(DriverPhase::Up));
  pump->command.reset();
  ASSERT_TRUE(with_device_until([&] { return device.speed_mps == 0.0F; }));
}

TEST_F(BoardAtTerminal, RubbishAndSwappedWiresAreCountedAndNamed) {
  start();
  terminal.say("\x80\x81\x82$RVF,garbage*00\r\n" + encode_text(Command{1, 0.5, 0.0, true}));
  ASSERT_TRUE(pump->until([&] { return pump->counted("damaged") > 0; }));
  ASSERT_TRUE(pump->until(
      [&] { return pump->counted("a command: the wires are swapped or echoed") == 1; }));
  EXPECT_TRUE(measured.empty());
  EXPECT_TRUE(is(DriverPhase::Opening));
}

TEST_F(BoardAtTerminal, AnotherDeviceOnThePortIsNamed) {
  start();
  ASSERT_TRUE(with_device_until([&] { return is(DriverPhase::Up); }));
  ASSERT_TRUE(pump->until([&] {
    terminal.hear();
    terminal.say("$GPHDT,359.97,T*04\r\n");
    return is(DriverPhase::Faulty);
  }));
  EXPECT_NE(pump->status().reason.find("another device"), std::string::npos)
      << pump->status().reason;
}

TEST_F(BoardAtTerminal, APulledPlugIsAFaultThatNamesItsCause) {
  start();
  ASSERT_TRUE(with_device_until([&] { return is(DriverPhase::Up); }));
  terminal.hang_up();
  ASSERT_TRUE(pump->until([&] { return is(DriverPhase::Faulty); }));
  EXPECT_FALSE(pump->status().reason.empty());
}

TEST(BoardOverUdp, DrivesItsPeerAndDropsForeignAddresses) {
  boost::asio::io_context io;
  link::UdpLink board(io, 0);
  TwistDevice device;
  board.on_bytes = [&](base::Bytes b, Time t) { hear(device, link::text_of(b), t); };
  ASSERT_TRUE(board.open());
  link::UdpLink* ours = nullptr;
  Driver driver(
      "twist", quick(),
      [&]() -> base::Result<std::unique_ptr<link::ByteLink>> {
        auto made =
            std::make_unique<link::UdpLink>(io, 0, link::UdpLink::Peer{"127.0.0.1", board.port()});
        ours = made.get();
        return made;
      },
      [](const base::Measurement&) {});
  driver.start(base::steady_now());
  link::Pump<Driver> pump(io, driver);
  pump.command = base::DriveCommand{{0.4, 0.0}, true};
  link::UdpLink stranger(io, 0, link::UdpLink::Peer{"127.0.0.1", ours->port()});
  ASSERT_TRUE(stranger.open());
  // A stranger that plays a whole board: the driver does not even come up
  TwistDevice theirs;
  ASSERT_TRUE(pump.until([&] {
    const std::string line = said_by(theirs, base::steady_now());
    if (!line.empty()) stranger.write(link::bytes_of(line));
    return pump.counted("from a foreign address") >= 5;
  }));
  EXPECT_EQ(pump.status().phase, DriverPhase::Opening);
  EXPECT_EQ(device.speed_mps, 0.0F);
  ASSERT_TRUE(pump.until([&] {
    const std::string line = said_by(device, base::steady_now());
    if (!line.empty()) board.write(link::bytes_of(line));
    return std::abs(device.speed_mps - 0.4F) < 1e-3F;
  }));
}

}  // namespace
}  // namespace roverd::twist
