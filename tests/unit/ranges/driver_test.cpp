// The driver at a pseudo-terminal.

#include "ranges/driver.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "link/serial.hpp"
#include "unit/link/pump.hpp"
#include "unit/link/terminal.hpp"

namespace roverd::ranges {
namespace {

using base::DriverPhase;

struct AtTerminal : ::testing::Test {
  AtTerminal() { driver.start(base::steady_now()); }
  static Params three() {
    Params p;
    p.count = 3;
    p.bearings_deg = "40 0 -40";
    p.fov_deg = "20";
    p.fan_step_deg = 10.0;
    return p;
  }

  boost::asio::io_context io;
  link::Terminal terminal;
  std::vector<std::shared_ptr<const base::Sight>> sights;
  Driver driver{"sonar", three(),
                [this]() -> base::Result<std::unique_ptr<link::ByteLink>> {
                  return std::make_unique<link::SerialLink>(io, terminal.path, 115200);
                },
                [](const base::Measurement&) {},
                [this](std::shared_ptr<const base::Sight> s) { sights.push_back(std::move(s)); }};
  link::Pump<Driver> pump{io, driver};
};

TEST_F(AtTerminal, ALineCutIntoPiecesIsToldOnceItIsWhole) {
  const std::string line = encode({1.0, 2.0, std::nullopt});
  terminal.say(line.substr(0, 5));
  terminal.say(line.substr(5));
  ASSERT_TRUE(pump.until([&] { return sights.size() == 1; }));
  EXPECT_EQ(pump.status().phase, DriverPhase::Up);
  EXPECT_EQ(sights[0]->sensor, "sonar");
  ASSERT_EQ(sights[0]->points.size(), 9U);
  EXPECT_NEAR(sights[0]->points[4].x_m, 2.0, 1e-5);
  EXPECT_EQ(sights[0]->points[8].echo, base::Echo::Unknown);
  EXPECT_EQ(pump.status().detail->facts.at("ranges_m"), "1.00 2.00 -");
  EXPECT_EQ(pump.status().detail->facts.at("missing_pct"), "33.3");
}

TEST_F(AtTerminal, WhatIsRefusedIsCountedByCause) {
  terminal.say("1.0 2.0\r\n1.0 0 nan\r\n0 0 0\r\n1.0 2.0 3.0*00\r\nwhat? 1.0\r\n");
  ASSERT_TRUE(pump.until([&] { return pump.counted("a word that makes no sense") == 1; }));
  EXPECT_EQ(pump.counted("a line with more or fewer ranges than set"), 1U);
  EXPECT_EQ(pump.counted("a range that is none"), 5U);
  EXPECT_EQ(pump.counted("a wrong checksum"), 1U);
  ASSERT_EQ(sights.size(), 1U) << "a line of refused ranges tells nothing";
  EXPECT_EQ(sights[0]->points[0].echo, base::Echo::Hit);
  EXPECT_EQ(sights[0]->points[3].echo, base::Echo::Unknown);
}

TEST_F(AtTerminal, SilenceAndAnotherDeviceAreFaultsWithTheirNames) {
  terminal.say(encode({1.0, 1.0, 1.0}));
  ASSERT_TRUE(pump.until_phase(DriverPhase::Up));
  ASSERT_TRUE(pump.until_phase(DriverPhase::Faulty));
  EXPECT_EQ(pump.status().reason, "no ranges: the port is silent");
  terminal.say(encode({1.0, 1.0, 1.0}));
  ASSERT_TRUE(pump.until_phase(DriverPhase::Up));
  terminal.hang_up();
  ASSERT_TRUE(pump.until_phase(DriverPhase::Faulty));
}

}  // namespace
}  // namespace roverd::ranges
