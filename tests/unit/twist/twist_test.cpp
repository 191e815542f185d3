#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "device_example.hpp"
#include "link/memory.hpp"
#include "twist/driver.hpp"

namespace roverd::twist {
namespace {

base::Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

const Command kCommandExample{7, 0.5, -0.25, true};
const Feedback kFeedbackExample{9, 7, 0.48, -0.2, 12.345, -0.5, 48.25, kObeying | kTooHot, true};

TEST(TwistText, BothMessagesComeBack) {
  EXPECT_EQ(encode_text(kCommandExample), "$RVC,7,0.500,-0.250,1*6E\r\n");
  TextDecoder decoder;
  std::vector<Said> all;
  const std::string both = "noise" + encode_text(kCommandExample) + encode_text(kFeedbackExample);
  for (const char c : both) {
    decoder.feed(bytes_of(std::string(1, c)), [&](const Said& s) { all.push_back(s); });
  }
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(std::get<Command>(all[0]), kCommandExample);
  EXPECT_EQ(std::get<Feedback>(all[1]), kFeedbackExample);
  EXPECT_EQ(decoder.refused(), 0U);
}

TEST(TwistText, EveryFlippedBitIsNoticed) {
  // $RVC,7,0.500,-0.250,1*6E: only the case of the checksum's letter may change without harm.
  const std::string good = encode_text(kCommandExample);
  std::size_t understood = 0;
  for (std::size_t i = 0; i < (good.size() - 2) * 8; ++i) {
    std::string bad = good;
    bad[i / 8] = static_cast<char>(bad[i / 8] ^ (1 << i % 8));
    TextDecoder decoder;
    decoder.feed(bytes_of(bad), [&](const Said& s) {
      ++understood;
      EXPECT_EQ(std::get<Command>(s), kCommandExample) << "bit " << i;
    });
  }
  EXPECT_EQ(understood, 1U);
}

/// A sealed line of these fields.
std::string line_of(const std::vector<std::string>& fields) {
  std::string body;
  for (const std::string& f : fields) body += (body.empty() ? "" : ",") + f;
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  char seal[8];
  std::snprintf(seal, sizeof seal, "*%02X", sum);
  return "$" + body + seal;
}

const std::vector<std::string> kCommandFields{"RVC", "7", "0.500", "-0.250", "1"};
const std::vector<std::string> kFeedbackFields{"RVF",    "9",      "7",     "0.480", "-0.200",
                                               "12.345", "-0.500", "48.25", "33",    "1"};

/// Refused with `bad`, understood with `good` as its field `at`.
void expect_range(std::vector<std::string> fields, std::size_t at, const std::string& good,
                  const std::string& bad) {
  fields[at] = good;
  EXPECT_NE(parse_text(line_of(fields)).index(), 0U) << at << " " << good;
  fields[at] = bad;
  EXPECT_EQ(parse_text(line_of(fields)).index(), 0U) << at << " " << bad;
}

TEST(TwistText, EachFieldHasItsRange) {
  EXPECT_EQ(std::get<Command>(parse_text(line_of(kCommandFields))), kCommandExample);
  EXPECT_EQ(std::get<Feedback>(parse_text(line_of(kFeedbackFields))), kFeedbackExample);
  for (const auto& fields : {kCommandFields, kFeedbackFields}) {
    for (std::size_t at = 1; at < fields.size(); ++at) {
      for (const char* bad : {"", "x", "1x", " 1", "nan", "-inf", "1e9", "99999999"}) {
        expect_range(fields, at, fields[at], bad);
      }
    }
  }
  for (const std::size_t at : {2U, 3U}) {
    expect_range(kCommandFields, at, "-100.000", "-100.001");
    expect_range(kFeedbackFields, at + 1, "100.000", "100.001");
  }
  for (const std::size_t at : {5U, 6U}) {
    expect_range(kFeedbackFields, at, "-10000000", "-10000001");
  }
  expect_range(kFeedbackFields, 7, "1000", "1001");
  expect_range(kCommandFields, 1, "255", "256");
  expect_range(kCommandFields, 4, "0", "2");
  for (const std::size_t at : {1U, 2U, 8U}) expect_range(kFeedbackFields, at, "255", "256");
  expect_range(kFeedbackFields, 9, "0", "2");
}

TEST(TwistText, ALineWithTooManyOrTooFewFieldsIsNeither) {
  for (auto fields : {kCommandFields, kFeedbackFields}) {
    fields.emplace_back("0");
    EXPECT_EQ(parse_text(line_of(fields)).index(), 0U);
    fields.pop_back();
    fields.pop_back();
    EXPECT_EQ(parse_text(line_of(fields)).index(), 0U);
  }
  for (const char* line : {"", "$", "*00", "$*00", "$RVC*47", "$RVX,7,0.500,-0.250,1*75"}) {
    EXPECT_EQ(parse_text(line).index(), 0U) << line;
  }
  EXPECT_EQ(parse_text(line_of(std::vector<std::string>(200, ""))).index(), 0U);
}

TEST(TwistBinary, BothMessagesComeBackBesideNoise) {
  EXPECT_EQ(crc16(bytes_of("123456789")), 0x29B1);
  std::vector<std::uint8_t> wire{0xA5, 0xA5, 0x5A, 0x01, 0x00, 0xFF};
  for (const auto& part : {encode_binary(kCommandExample), encode_binary(kFeedbackExample)}) {
    wire.insert(wire.end(), part.begin(), part.end());
  }
  BinaryDecoder decoder;
  std::vector<Said> all;
  for (const std::uint8_t b : wire) {
    decoder.feed({&b, 1}, [&](const Said& s) { all.push_back(s); });
  }
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(std::get<Command>(all[0]), kCommandExample);
  EXPECT_EQ(std::get<Feedback>(all[1]), kFeedbackExample);
}

TEST(TwistBinary, WhatTheWireCannotHoldIsCutToItAndNoNumberIsZero) {
  const auto there_and_back = [](const auto& message) {
    Said said;
    BinaryDecoder().feed(encode_binary(message), [&](const Said& s) { said = s; });
    return said;
  };
  const auto most =
      std::get<Feedback>(there_and_back(Feedback{1, 2, 99.0, -99.0, 3e6, -3e6, 700.0, 255, false}));
  EXPECT_EQ(most, (Feedback{1, 2, 32.767, -32.768, 2147483.647, -2147483.648, 655.35, 255, false}));
  const double nan = std::nan("");
  const auto none =
      std::get<Feedback>(there_and_back(Feedback{1, 2, nan, nan, nan, nan, nan, 0, true}));
  EXPECT_EQ(none, (Feedback{1, 2, 0.0, 0.0, 0.0, 0.0, 0.0, 0, true}));
  const auto below = std::get<Feedback>(there_and_back(Feedback{.battery_v = -1.0}));
  EXPECT_EQ(below.battery_v, 0.0);
  const auto command = std::get<Command>(there_and_back(Command{3, -99.0, 99.0, true}));
  EXPECT_EQ(command, (Command{3, -32.768, 32.767, true}));
}

TEST(TwistBinary, EveryFlippedBitIsNoticed) {
  const auto good = encode_binary(kFeedbackExample);
  for (std::size_t i = 0; i < good.size() * 8; ++i) {
    auto bad = good;
    bad[i / 8] ^= static_cast<std::uint8_t>(1U << i % 8);
    BinaryDecoder().feed(bad, [&](const Said&) { FAIL() << "bit " << i; });
  }
}

struct Board : ::testing::Test {
  void make(const std::string& form) {
    EXPECT_TRUE(wire.b->open());
    Params p;
    p.form = form;
    driver = std::make_unique<Driver>(
        "twist", p,
        [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire.a)); },
        [this](const base::Measurement& m) {
          if (const auto* s = std::get_if<base::BaseStatus>(&m)) status = *s;
          if (const auto* t = std::get_if<base::WheelTravel>(&m)) travelled_m += t->left_m;
        });
    wire.b->on_bytes = [this](base::Bytes bytes, Time) {
      for (const std::uint8_t b : bytes) device.byte_in(static_cast<char>(b), ms());
    };
    driver->start(now);
  }
  std::uint32_t ms() const {
    return static_cast<std::uint32_t>(base::seconds(now.time_since_epoch()) * 1e3);
  }
  void run(double seconds) {
    for (int i = 0; i < seconds * 100.0; ++i) {
      now += std::chrono::milliseconds(10);
      if (command && i % 2 == 0) driver->send(*command, now);
      device.left_m += device.speed_mps * 0.01F;
      char out[160];
      const int n = device.loop(ms(), out, sizeof out);
      if (n > 0 && device_speaks) wire.b->write(bytes_of({out, static_cast<std::size_t>(n)}));
      ours->deliver(now);
      driver->tick(now);
      if (wire_whole) wire.b->deliver(now);
    }
  }
  Time now{};
  link::MemoryBytePair wire = link::memory_byte_pair();
  link::MemoryByteLink* ours = wire.a.get();
  TwistDevice device;
  bool device_speaks = true;
  bool wire_whole = true;
  base::BaseStatus status;
  double travelled_m = 0.0;
  std::unique_ptr<Driver> driver;
  std::optional<base::DriveCommand> command;
};

TEST_F(Board, DriverAndDeviceExampleUnderstandEachOther) {
  make("text");
  run(0.5);
  EXPECT_EQ(driver->status(now).phase, base::DriverPhase::Up);
  EXPECT_EQ(status.control_mode, base::ControlMode::Standby);
  command = base::DriveCommand{{0.5, 0.3}, true};
  run(2.0);
  EXPECT_FLOAT_EQ(device.speed_mps, 0.5F);
  EXPECT_FLOAT_EQ(device.turn_radps, 0.3F);
  EXPECT_EQ(status.control_mode, base::ControlMode::Can);
  EXPECT_NEAR(travelled_m, 0.95, 0.1);
  EXPECT_EQ(driver->status(now).refused, 0U);
}

TEST_F(Board, TheDeviceStopsByItselfWhenTheWireBreaks) {
  make("text");
  command = base::DriveCommand{{0.5, 0.0}, true};
  run(1.0);
  EXPECT_GT(device.speed_mps, 0.4F);
  wire_whole = false;
  run(0.4);
  EXPECT_EQ(device.speed_mps, 0.0F);
}

TEST_F(Board, SilentFeedbackAndOldCommandsStopTheDriver) {
  make("text");
  command = base::DriveCommand{{0.5, 0.0}, true};
  run(1.0);
  device_speaks = false;
  run(0.4);
  EXPECT_EQ(device.speed_mps, 0.0F);
  EXPECT_EQ(driver->status(now).phase, base::DriverPhase::Faulty);
  device_speaks = true;
  run(1.0);
  EXPECT_FLOAT_EQ(device.speed_mps, 0.5F);
  command.reset();
  run(0.3);
  EXPECT_EQ(device.speed_mps, 0.0F);
}

TEST_F(Board, ItsButtonIsTheBasesEmergencyStop) {
  make("text");
  run(0.5);
  device.estop = true;
  run(0.3);
  EXPECT_EQ(status.vehicle_state, base::VehicleState::Estop);
}

TEST_F(Board, ADeviceOfTheOtherFormIsNeverUp) {
  make("binary");
  run(1.0);
  EXPECT_EQ(driver->status(now).phase, base::DriverPhase::Opening);
}

}  // namespace
}  // namespace roverd::twist
