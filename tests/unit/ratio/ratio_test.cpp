#include <vector>

#include <gtest/gtest.h>

#include "link/memory.hpp"
#include "ratio/driver.hpp"

namespace roverd::ratio {
namespace {

base::Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(RatioCodec, TheLineIsAsDocumented) {
  EXPECT_EQ(encode({0.3, -0.25}), "0.300 -0.250\n");
  EXPECT_EQ(encode({-0.0, -0.0001}), "0.000 0.000\n");
  EXPECT_EQ(parse("0.300 -0.250"), (Message{0.3, -0.25}));
}

TEST(RatioCodec, TwistsComeBackAlsoBackwardsAndOnTheSpot) {
  for (const double v : {-0.5, -0.1, 0.0, 0.2, 0.6}) {
    for (const double w : {-1.5, -0.3, 0.0, 0.4, 2.0}) {
      const Message m = from_twist({v, w}, 0.4);
      EXPECT_LE(std::abs(m.ratio), 2.0 + 1e-9);
      const auto back = to_twist(m, 0.4);
      EXPECT_NEAR(back.linear_mps, v, 1e-9);
      EXPECT_NEAR(back.angular_radps, w, 1e-9);
    }
  }
  EXPECT_GT(from_twist({0.3, 0.2}, 0.4).ratio, 0.0) << "left turn: the left wheel is slower";
}

TEST(RatioCodec, TheWheelsTurnAsDescribed) {
  // Tracks 0.4 m apart: left 0.95 and right 1.00 m/s turn by 0.05 / 0.4 rad/s.
  const base::BodyTwist left = to_twist({1.0, 0.05}, 0.4);
  EXPECT_DOUBLE_EQ(left.linear_mps, 0.975);
  EXPECT_NEAR(left.angular_radps, 0.125, 1e-12);
  const base::BodyTwist right = to_twist({1.0, -0.05}, 0.4);
  EXPECT_DOUBLE_EQ(right.linear_mps, 0.975);
  EXPECT_NEAR(right.angular_radps, -0.125, 1e-12);
  const base::BodyTwist on_the_spot = to_twist({0.5, 2.0}, 0.4);
  EXPECT_DOUBLE_EQ(on_the_spot.linear_mps, 0.0);
  EXPECT_NEAR(on_the_spot.angular_radps, 2.5, 1e-12);
  const Message spin = from_twist({0.0, 2.5}, 0.4);
  EXPECT_DOUBLE_EQ(spin.speed_mps, 0.5);
  EXPECT_DOUBLE_EQ(spin.ratio, 2.0);
  const Message one_stands = from_twist({-0.25, 1.25}, 0.4);
  EXPECT_DOUBLE_EQ(one_stands.speed_mps, -0.5);
  EXPECT_DOUBLE_EQ(one_stands.ratio, -1.0);
}

TEST(RatioCodec, DamagedLinesAreCountedAndHalvesWait) {
  for (const char* bad : {"", "1", "1 2 3", "1 nan", "inf 0", "0.1 2.5", "0x1 0", " 1 0", "1  0"}) {
    EXPECT_FALSE(parse(bad)) << bad;
  }
  Decoder decoder;
  std::vector<Message> all;
  const auto keep = [&](const Message& m) { all.push_back(m); };
  decoder.feed(bytes_of("0.5 0"), keep);
  EXPECT_TRUE(all.empty());
  decoder.feed(bytes_of(".25\r\n\nrubbish\n" + std::string(500, '1') + "\n0.1 0\n"), keep);
  EXPECT_EQ(all, (std::vector<Message>{{0.5, 0.25}, {0.1, 0.0}}));
  EXPECT_EQ(decoder.refused(), 2U);
}

struct Robot : ::testing::Test {
  Robot() {
    EXPECT_TRUE(wire.b->open());
    wire.b->on_bytes = [this](base::Bytes b, Time) {
      decoder.feed(b, [this](const Message& m) {
        heard.push_back(m);
        at.push_back(now);
      });
    };
    driver.start(now);
  }
  void run(double seconds) {
    for (int i = 0; i < seconds * 100.0; ++i) {
      now += std::chrono::milliseconds(10);
      if (command && i % 2 == 0) driver.send(*command, now);
      driver.tick(now);
      wire.b->deliver(now);
    }
  }
  Time now{};
  link::MemoryBytePair wire = link::memory_byte_pair();
  link::MemoryByteLink* ours = wire.a.get();
  std::vector<base::Measurement> said;
  Driver driver{"ratio",
                {},
                [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire.a)); },
                [this](const base::Measurement& m) { said.push_back(m); }};
  Decoder decoder;
  std::vector<Message> heard;
  std::vector<Time> at;
  std::optional<base::DriveCommand> command;
};

TEST_F(Robot, HearsALineEveryFifthOfASecondAndTheStopAtOnce) {
  run(1.0);
  EXPECT_NEAR(static_cast<double>(heard.size()), 5.0, 1.0);
  command = base::DriveCommand{{0.3, 0.3}, true};
  run(2.0);
  EXPECT_NEAR(to_twist(heard.back(), 0.4).linear_mps, 0.3, 2e-3);
  EXPECT_NEAR(to_twist(heard.back(), 0.4).angular_radps, 0.3, 5e-3);
  const Time before = now;
  command = base::DriveCommand{};
  run(0.05);
  EXPECT_EQ(heard.back(), Message{});
  EXPECT_LT(at.back() - before, std::chrono::milliseconds(30));
}

TEST_F(Robot, StopsWithoutNewCommandsAndNeverGrowsFasterThanAllowed) {
  run(0.5);
  command = base::DriveCommand{{9.0, 0.0}, true};
  run(3.0);
  for (std::size_t i = 1; i < heard.size(); ++i) {
    EXPECT_LE(heard[i].speed_mps - heard[i - 1].speed_mps, 0.402);
  }
  EXPECT_EQ(heard.back().speed_mps, 0.8);
  command.reset();
  run(0.3);
  EXPECT_EQ(heard.back(), Message{});
}

TEST_F(Robot, IsConnectedAgainAfterALoss) {
  run(0.5);
  EXPECT_EQ(driver.status(now).phase, base::DriverPhase::Up);
  ours->fail("reset by peer");
  EXPECT_EQ(driver.status(now).phase, base::DriverPhase::Faulty);
  run(1.5);
  EXPECT_EQ(driver.status(now).phase, base::DriverPhase::Up);
}

TEST_F(Robot, WhatItSendsBackIsMeasured) {
  run(0.5);
  said.clear();
  wire.b->write(bytes_of("0.200 0.000\n0.3"));
  ours->deliver(now);
  ASSERT_EQ(said.size(), 1U);
  const auto& motion = std::get<base::BaseMotion>(said[0]);
  EXPECT_FALSE(motion.assumed);
  EXPECT_EQ(motion.twist.linear_mps, 0.2);
}

}  // namespace
}  // namespace roverd::ratio
