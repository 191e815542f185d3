// The car over real UDP sockets.

#include "link/udp.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "ackermann/driver.hpp"
#include "unit/link/pump.hpp"

namespace roverd::ackermann {
namespace {

using base::DriverPhase;

struct CarOverUdp : ::testing::Test {
  CarOverUdp() {
    car.on_bytes = [this](base::Bytes b, Time) { heard.push_back(decode(b).message); };
    EXPECT_TRUE(car.open());
    driver.start(base::steady_now());
  }
  static Params strict() {
    Params p;
    p.feedback_required = true;
    p.silent_reopen_s = 0.0;
    return p;
  }
  /// The car answers each command with what it does.
  bool until_up() {
    return pump.until([&] {
      car.write(encode({0.5F, 0.0F, DriveMode::Autonomous}));
      return pump.status().phase == DriverPhase::Up;
    });
  }

  boost::asio::io_context io;
  link::UdpLink car{io, 0};
  std::vector<Message> heard;
  std::vector<base::BaseMotion> measured;
  std::uint16_t our_port = 0;
  Driver driver{"ackermann", strict(),
                [this]() -> base::Result<std::unique_ptr<link::ByteLink>> {
                  auto made = std::make_unique<link::UdpLink>(
                      io, 0, link::UdpLink::Peer{"127.0.0.1", car.port()});
                  ours = made.get();
                  return made;
                },
                [this](const base::Measurement& m) {
                  if (const auto* b = std::get_if<base::BaseMotion>(&m)) measured.push_back(*b);
                }};
  link::UdpLink* ours = nullptr;
  link::Pump<Driver> pump{io, driver};
};

TEST_F(CarOverUdp, ADatagramFromAForeignAddressIsCountedAndNeverActedUpon) {
  ASSERT_TRUE(pump.until([&] { return !heard.empty(); }));
  link::UdpLink stranger(io, 0, link::UdpLink::Peer{"127.0.0.1", ours->port()});
  ASSERT_TRUE(stranger.open());
  ASSERT_TRUE(pump.until([&] {
    stranger.write(encode({1.0F, 0.3F, DriveMode::Autonomous}));
    return pump.counted("from a foreign address") >= 5;
  }));
  EXPECT_EQ(pump.status().phase, DriverPhase::Opening) << "only the car itself brings it up";
  EXPECT_EQ(pump.status().received, 0U);
  EXPECT_TRUE(measured.empty());
  EXPECT_EQ(heard.back().mode, DriveMode::Park);
}

TEST_F(CarOverUdp, DrivesWhileTheCarAnswersAndParksWhenItFallsSilent) {
  pump.command = base::DriveCommand{{1.0, 0.0}, true};
  ASSERT_TRUE(until_up());
  ASSERT_TRUE(pump.until([&] {
    car.write(encode({0.5F, 0.0F, DriveMode::Autonomous}));
    return heard.back().speed_mps == 1.0F;
  }));
  EXPECT_EQ(heard.back().mode, DriveMode::Autonomous);
  ASSERT_TRUE(pump.until_phase(DriverPhase::Faulty));
  ASSERT_TRUE(pump.until([&] { return heard.back().mode == DriveMode::Park; }));
  EXPECT_EQ(heard.back().speed_mps, 0.0F);
}

TEST_F(CarOverUdp, WrongDatagramsOfTheCarItselfAreCountedByCause) {
  ASSERT_TRUE(until_up());
  const auto before = measured.size();
  auto twice = std::vector<std::uint8_t>(24, 0x10);
  auto marked = encode({0.5F, 0.0F, DriveMode::Park});
  marked[0] = 0x11;
  ASSERT_TRUE(pump.until([&] {
    car.write(twice);
    car.write(marked);
    car.write(encode({std::nanf(""), 0.0F, DriveMode::Park}));
    car.write(encode({32.0F, 0.0F, DriveMode::Park}));
    car.write(encode({0.0F, 1.6F, DriveMode::Park}));
    return pump.counted("impossible wheel angle") > 0;
  }));
  EXPECT_GT(pump.counted(to_string(Fault::WrongLength)), 0U);
  EXPECT_GT(pump.counted(to_string(Fault::WrongMark)), 0U);
  EXPECT_GT(pump.counted(to_string(Fault::NotFinite)), 0U);
  EXPECT_GT(pump.counted("impossible speed"), 0U);
  for (std::size_t i = before; i < measured.size(); ++i) {
    EXPECT_EQ(measured[i].twist.linear_mps, 0.5) << "what was on its way before";
  }
}

}  // namespace
}  // namespace roverd::ackermann
