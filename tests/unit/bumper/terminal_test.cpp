// The bumper at a pseudo-terminal.

#include "unit/link/terminal.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "bumper/driver.hpp"
#include "link/serial.hpp"
#include "unit/link/pump.hpp"

namespace roverd::bumper {
namespace {

using base::DriverPhase;

struct AtTerminal : ::testing::Test {
  AtTerminal() { driver.start(base::steady_now()); }
  static Params quick() {
    Params p;
    p.retry_first_s = p.retry_max_s = 0.05;
    return p;
  }
  bool hazard() const { return !pump.status().detail->hazards.empty(); }

  boost::asio::io_context io;
  link::Terminal terminal;
  std::vector<base::Bumper> hits;
  Driver driver{"bumper", quick(),
                [this]() -> base::Result<std::unique_ptr<link::ByteLink>> {
                  return std::make_unique<link::SerialLink>(io, terminal.path, 115200);
                },
                [this](const base::Measurement& m) {
                  if (const auto* b = std::get_if<base::Bumper>(&m)) hits.push_back(*b);
                }};
  link::Pump<Driver> pump{io, driver};
};

TEST_F(AtTerminal, AHitCutIntoPiecesIsToldOnceItIsWhole) {
  EXPECT_TRUE(hazard());
  terminal.say("B,");
  terminal.say(encode(0).substr(2) + encode(2).substr(0, 3));
  ASSERT_TRUE(pump.until([&] { return hits.size() == 1; }));
  EXPECT_FALSE(hits[0].pressed);
  EXPECT_FALSE(hazard());
  terminal.say(encode(2).substr(3));
  ASSERT_TRUE(pump.until([&] { return hits.size() == 2; }));
  EXPECT_TRUE(hits[1].pressed);
  EXPECT_EQ(hits[1].where, "front");
}

TEST_F(AtTerminal, RubbishIsCountedAndKeepsTheHazard) {
  terminal.say("\xFF\xFE\x01 rubbish\r\nB,0*5F\r\n");
  ASSERT_TRUE(pump.until([&] { return pump.counted("damaged line") == 2; }));
  EXPECT_TRUE(hits.empty());
  EXPECT_TRUE(hazard());
}

TEST_F(AtTerminal, SilenceAndAnotherDeviceAreFaultsWithTheirNames) {
  terminal.say(encode(0));
  ASSERT_TRUE(pump.until_phase(DriverPhase::Up));
  ASSERT_TRUE(pump.until_phase(DriverPhase::Faulty));
  EXPECT_EQ(pump.status().reason, "no intact line: the port is silent");
  EXPECT_TRUE(hazard());
  terminal.say(encode(0));
  ASSERT_TRUE(pump.until_phase(DriverPhase::Up));
  ASSERT_TRUE(pump.until([&] {
    terminal.say("$GPHDT,359.97,T*04\r\n");
    return pump.status().phase == DriverPhase::Faulty;
  }));
  EXPECT_EQ(pump.status().reason,
            "no intact line, only other bytes: another device on this port, or a wrong baud rate");
}

TEST_F(AtTerminal, APulledPlugIsAHazardAtOnce) {
  terminal.say(encode(0));
  ASSERT_TRUE(pump.until_phase(DriverPhase::Up));
  terminal.hang_up();
  ASSERT_TRUE(pump.until_phase(DriverPhase::Faulty));
  EXPECT_TRUE(hazard());
}

}  // namespace
}  // namespace roverd::bumper
