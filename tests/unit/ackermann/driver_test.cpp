#include "ackermann/driver.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "link/memory.hpp"

namespace roverd::ackermann {
namespace {

class Car : public ::testing::Test {
 protected:
  void make(const Params& p) {
    wire_ = link::memory_byte_pair();
    car_ = wire_.b.get();
    side_ = wire_.a.get();
    wire_.b->on_bytes = [this](Bytes b, Time) { heard.push_back(decode(b).message); };
    ASSERT_TRUE(wire_.b->open());
    driver = std::make_unique<Driver>(
        "ackermann", p,
        [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire_.a)); },
        [this](const base::Measurement& m) { said.push_back(m); });
    driver->start(now);
  }

  void run(double seconds) {
    for (int i = 0; i < seconds * 100.0; ++i) {
      now += std::chrono::milliseconds(10);
      if (command && i % 2 == 0) driver->send(*command, now);
      if (answers) car_->write(encode(answer));
      side_->deliver(now);
      driver->tick(now);
      car_->deliver(now);
    }
  }
  template <class T>
  const T* last() const {
    const T* found = nullptr;
    for (const auto& m : said) {
      if (const auto* value = std::get_if<T>(&m)) found = value;
    }
    return found;
  }

  std::unique_ptr<Driver> driver;
  std::vector<Message> heard;
  std::vector<base::Measurement> said;
  std::optional<base::DriveCommand> command;
  bool answers = false;
  Message answer;
  Time now{};
  link::MemoryBytePair wire_;
  link::MemoryByteLink* car_ = nullptr;
  link::MemoryByteLink* side_ = nullptr;
};

TEST_F(Car, ParksUntilSomebodyDrivesAndRepeatsAHundredTimesASecond) {
  make({});
  run(1.0);
  ASSERT_GE(heard.size(), 99U);
  for (const auto& m : heard) EXPECT_EQ(m, (Message{0.0F, 0.0F, DriveMode::Park}));
  EXPECT_EQ(driver->status(now).phase, base::DriverPhase::Up);
  EXPECT_TRUE(last<base::BaseMotion>()->assumed);
  EXPECT_EQ(last<base::BaseStatus>()->control_mode, base::ControlMode::Can);
}

TEST_F(Car, ATwistBecomesSpeedAndWheelAngleWithinTheirRates) {
  make({});
  run(0.1);
  heard.clear();
  command = base::DriveCommand{{1.0, 0.4}, true};
  run(2.0);
  for (std::size_t i = 1; i < heard.size(); ++i) {
    EXPECT_LE(std::abs(heard[i].wheel_rad - heard[i - 1].wheel_rad), 0.8 * 0.0101);
    EXPECT_LE(heard[i].speed_mps - heard[i - 1].speed_mps, 3.0 * 0.0101);
  }
  EXPECT_EQ(heard.back().mode, DriveMode::Autonomous);
  EXPECT_FLOAT_EQ(heard.back().speed_mps, 1.0F);
  EXPECT_NEAR(heard.back().wheel_rad, std::atan(0.52), 1e-6);
  // At standstill the wheel stays where it is.
  command = base::DriveCommand{{0.0, 0.0}, true};
  run(0.5);
  EXPECT_EQ(heard.back().speed_mps, 0.0F);
  EXPECT_NEAR(heard.back().wheel_rad, std::atan(0.52), 1e-6);
}

TEST_F(Car, WishesBeyondTheLimitsAreCut) {
  make({});
  command = base::DriveCommand{{50.0, 500.0}, true};
  run(4.0);
  EXPECT_NEAR(heard.back().speed_mps, 1.4, 1e-6);
  EXPECT_NEAR(heard.back().wheel_rad, 0.7, 1e-6);
}

TEST_F(Car, ACommandOlderThanAQuarterSecondIsAStop) {
  make({});
  command = base::DriveCommand{{1.0, 0.0}, true};
  run(1.0);
  EXPECT_EQ(heard.back().speed_mps, 1.0F);
  command.reset();
  run(0.2);
  EXPECT_EQ(heard.back().speed_mps, 1.0F);
  run(0.1);
  EXPECT_EQ(heard.back(), (Message{0.0F, 0.0F, DriveMode::Park}));
}

TEST_F(Car, NotANumberIsAStop) {
  make({});
  command = base::DriveCommand{{std::nan(""), 0.0}, true};
  run(0.5);
  EXPECT_EQ(heard.back(), (Message{0.0F, 0.0F, DriveMode::Park}));
}

TEST_F(Car, FeedbackIsMeasuredAndItsSilenceStopsTheCar) {
  Params p;
  p.feedback_required = true;
  make(p);
  run(0.5);
  EXPECT_EQ(driver->status(now).phase, base::DriverPhase::Opening);
  command = base::DriveCommand{{1.0, 0.0}, true};
  run(0.5);
  EXPECT_EQ(heard.back().speed_mps, 0.0F) << "nobody answers";

  answers = true;
  answer = {0.9F, 0.1F, DriveMode::Autonomous};
  run(1.0);
  EXPECT_EQ(heard.back().speed_mps, 1.0F);
  EXPECT_EQ(driver->status(now).phase, base::DriverPhase::Up);
  EXPECT_FALSE(last<base::BaseMotion>()->assumed);
  EXPECT_NEAR(last<base::BaseMotion>()->twist.angular_radps, 0.9 * std::tan(0.1) / 1.3, 1e-6);
  EXPECT_NEAR(last<base::SteeringState>()->wheel_rad, 0.1, 1e-6);

  answers = false;
  run(0.4);
  EXPECT_EQ(heard.back().speed_mps, 0.0F);
  EXPECT_EQ(heard.back().mode, DriveMode::Park);
  EXPECT_EQ(driver->status(now).phase, base::DriverPhase::Faulty);
}

TEST_F(Car, WhatTellsNothingIsBelievedToFollowLate) {
  Params p;
  p.assumed_delay_s = 0.4;
  make(p);
  command = base::DriveCommand{{1.0, 0.0}, true};
  run(2.0);
  EXPECT_NEAR(last<base::BaseMotion>()->twist.linear_mps, 1.0, 1e-6);
  command = base::DriveCommand{{1.0, 0.2}, true};
  run(0.3);
  EXPECT_EQ(last<base::BaseMotion>()->twist.angular_radps, 0.0);
  run(2.0);
  EXPECT_NEAR(last<base::BaseMotion>()->twist.angular_radps, 0.2, 1e-6);
}

TEST_F(Car, SaysRemoteWhileAPersonDrivesFromThere) {
  make({});
  answers = true;
  answer = {0.5F, 0.0F, DriveMode::Remote};
  run(0.5);
  EXPECT_EQ(heard.back(), (Message{0.0F, 0.0F, DriveMode::Remote}));
  EXPECT_EQ(last<base::BaseStatus>()->control_mode, base::ControlMode::Radio);
}

TEST_F(Car, BadDatagramsAreCountedByCauseAndMoveNothing) {
  make({});
  run(0.1);
  car_->write(std::vector<std::uint8_t>{1, 2, 3});
  car_->write(encode({99.0F, 0.0F, DriveMode::Autonomous}));
  run(0.02);
  const auto status = driver->status(now);
  EXPECT_EQ(status.refused, 2U);
  EXPECT_EQ(status.detail->counts.at("wrong length"), 1U);
  EXPECT_EQ(status.detail->counts.at("impossible speed"), 1U);
  EXPECT_TRUE(last<base::BaseMotion>()->assumed);
}

TEST_F(Car, StopsWithParkAndTheZeroIsAddedToEveryAngle) {
  Params p;
  p.zero_rad = 0.05;
  make(p);
  command = base::DriveCommand{{1.0, 0.0}, true};
  run(1.0);
  EXPECT_NEAR(heard.back().wheel_rad, 0.05, 1e-6);
  wire_.b->set_immediate({});
  side_->set_immediate([this] { return now; });  // what is written last still arrives
  heard.clear();
  driver->stop(now);
  ASSERT_EQ(heard.size(), 3U);
  EXPECT_EQ(heard.back().mode, DriveMode::Park);
  EXPECT_EQ(driver->status(now).phase, base::DriverPhase::Down);
}

}  // namespace
}  // namespace roverd::ackermann
