// The MTi driver over a memory link: the handshake, the states, and what it counts.

#include "mti/driver.hpp"

#include <gtest/gtest.h>

#include "link/memory.hpp"
#include "unit/mti/messages.hpp"
#include "unit/mti/words.hpp"

namespace roverd::mti {
namespace {

using namespace std::chrono_literals;
using Phase = base::DriverPhase;

/// The driver with a unit at the other end that a test speaks for.
struct Bench {
  explicit Bench(const Params& p = {})
      : wire(link::memory_byte_pair()),
        driver(
            "mti", p,
            [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire.a)); },
            [this](const base::Measurement& m) { heard.push_back(m); }) {
    driver_end = wire.a.get();
    driver_end->set_immediate([this] { return now; });
    wire.b->set_immediate([this] { return now; });
    wire.b->on_bytes = [this](base::Bytes b, base::Time) {
      framer.feed(b, [this](const Message& m) {
        requests.push_back(m.mid);
        if (answer) answer(m);
      });
    };
    EXPECT_TRUE(wire.b->open());
    driver.start(now);
  }

  void wait(base::Duration d) {
    for (base::Duration t{}; t < d; t += 20ms) {
      now += 20ms;
      driver.tick(now);
    }
  }
  void say(const std::vector<std::uint8_t>& bytes) { wire.b->write(bytes); }
  /// Samples at 100 Hz.
  void measure(base::Duration d, bool counting = true) {
    for (base::Duration t{}; t < d; t += 10ms) {
      now += 10ms;
      if (counting) word.count += 100;
      ++word.number;
      say(encode(mid::kMtData2, word.builder().payload()));
      driver.tick(now);
    }
  }
  /// Acknowledges everything as a unit does that can send all but the field.
  void obey() {
    answer = [this](const Message& m) {
      std::vector<std::uint8_t> payload;
      if (m.mid == mid::kReqDid) payload = {0x07, 0x70, 0x01, 0x23};
      if (m.mid == mid::kProductCode - 1) payload = {'M', 'T', 'i', ' ', ' '};
      if (m.mid == mid::kFirmware - 1) payload = {1, 4, 2};
      if (m.mid == mid::kSetOutput) {
        auto list = outputs_of(m.payload);
        list.back().rate_hz = 0;
        const auto whole = encode(list);
        payload.assign(whole.begin() + 4, whole.end() - 1);
      }
      say(encode(static_cast<std::uint8_t>(m.mid + 1U), payload));
    };
  }
  base::DriverStatus status() const { return driver.status(now); }
  std::uint64_t count(const std::string& what) const {
    const auto s = status();
    const auto found = s.detail->counts.find(what);
    return found == s.detail->counts.end() ? 0 : found->second;
  }
  std::string fact(const std::string& key) const {
    const auto s = status();
    const auto found = s.detail->facts.find(key);
    return found == s.detail->facts.end() ? "" : found->second;
  }

  base::Time now{100s};
  link::MemoryBytePair wire;
  link::MemoryByteLink* driver_end = nullptr;
  Framer framer;
  std::vector<std::uint8_t> requests;
  std::function<void(const Message&)> answer;
  std::vector<base::Measurement> heard;
  Word word;
  Driver driver;
};

TEST(MtiDriver, ListensWithoutAskingAnything) {
  Bench b;
  EXPECT_EQ(b.status().phase, Phase::Opening);
  b.measure(200ms);
  EXPECT_EQ(b.status().phase, Phase::Up);
  EXPECT_EQ(b.status().received, 20u);
  EXPECT_EQ(b.status().refused, 0u);
  EXPECT_TRUE(b.requests.empty());
  EXPECT_EQ(all_of<base::Inertial>(b.heard).size(), 20u);
  EXPECT_EQ(b.fact("self_test"), "ok");
}

TEST(MtiDriver, ConfiguresAUnitStepByStep) {
  Bench b({.configure = true});
  b.obey();
  b.wait(200ms);
  const std::vector<std::uint8_t> steps{mid::kGoToConfig,   mid::kReqDid,    mid::kProductCode - 1,
                                        mid::kFirmware - 1, mid::kSetOutput, mid::kGoToMeasurement};
  EXPECT_EQ(b.requests, steps);
  EXPECT_EQ(b.fact("device"), "07700123");
  EXPECT_EQ(b.fact("product"), "MTi");
  EXPECT_EQ(b.fact("firmware"), "1.4.2");
  EXPECT_EQ(b.fact("configuration"), "magnetic_field not offered");
  EXPECT_EQ(b.status().sent, 6u);
}

TEST(MtiDriver, DataUnderWayBeforeTheAcknowledgeAreUsed) {
  Bench b({.configure = true});
  b.wait(20ms);
  ASSERT_EQ(b.requests.size(), 1u);
  b.measure(30ms);
  EXPECT_EQ(b.status().phase, Phase::Up);
  EXPECT_EQ(b.fact("configuration"), "asking for configuration state");
  b.say(from_hex(kGoToConfigAck));
  b.wait(20ms);
  EXPECT_EQ(b.requests.back(), mid::kReqDid);
}

TEST(MtiDriver, ARefusalIsNamedAndTheUnitMeasuresWithWhatItHas) {
  Bench b({.configure = true});
  b.answer = [&](const Message& m) {
    if (m.mid == mid::kSetOutput) return b.say(from_hex(kError));
    b.say(encode(static_cast<std::uint8_t>(m.mid + 1U), {}));
  };
  b.wait(300ms);
  EXPECT_EQ(b.fact("configuration"), "outputs refused: parameter invalid");
  EXPECT_EQ(b.requests.back(), mid::kGoToMeasurement);
  EXPECT_EQ(b.count("error from the unit: parameter invalid"), 1u);
}

TEST(MtiDriver, AUnitThatDoesNotAnswerIsAskedForThreeSeconds) {
  Bench b({.configure = true});
  b.wait(4s);
  EXPECT_EQ(b.requests.size(), 30u);
  EXPECT_EQ(b.fact("configuration"), "the unit does not answer");
  EXPECT_EQ(b.status().phase, Phase::Faulty);
  b.measure(100ms);  // it only measures, and that is good as well
  EXPECT_EQ(b.status().phase, Phase::Up);
}

TEST(MtiDriver, AUnitThatBeganAnewIsConfiguredAgain) {
  Bench b({.configure = true});
  b.obey();
  b.wait(200ms);
  b.requests.clear();
  b.say(encode(mid::kWakeUp, {}));
  b.wait(200ms);
  EXPECT_EQ(b.requests.size(), 6u);
  EXPECT_EQ(b.count("the unit began anew"), 1u);
}

TEST(MtiDriver, SilenceIsToldAndEndsWithTheNextSample) {
  Bench b;
  b.measure(100ms);
  b.wait(1s);
  EXPECT_EQ(b.status().phase, Phase::Faulty);
  EXPECT_EQ(b.status().reason, "no sample: the port is silent");
  b.measure(20ms);
  EXPECT_EQ(b.status().phase, Phase::Up);
}

TEST(MtiDriver, AUnitThatRepeatsItselfIsNeverUpAgain) {
  Bench b;
  b.measure(100ms);
  const auto told = all_of<base::Inertial>(b.heard).size();
  b.measure(5s, false);
  EXPECT_EQ(b.status().phase, Phase::Faulty);
  EXPECT_EQ(b.status().reason, "the unit repeats itself: its sample time stands still");
  EXPECT_EQ(all_of<base::Inertial>(b.heard).size(), told);
  EXPECT_EQ(b.count("sample time standing still"), 500u);
  EXPECT_EQ(b.status().refused, 500u);
}

TEST(MtiDriver, AFailedSelfTestIsTheReason) {
  Bench b;
  b.word.status = 0;
  b.measure(1s);
  EXPECT_EQ(b.status().phase, Phase::Faulty);
  EXPECT_EQ(b.status().reason, "the unit's self-test failed");
  EXPECT_TRUE(all_of<base::Inertial>(b.heard).empty());
}

TEST(MtiDriver, OtherBytesOnThePortAreSaidToBeOthers) {
  Bench b;
  for (int i = 0; i < 60; ++i) {
    b.say({'$', 'G', 'P', '\r', '\n'});
    b.wait(20ms);
  }
  EXPECT_EQ(b.status().phase, Phase::Faulty);
  EXPECT_EQ(b.status().reason,
            "no sample, only other bytes: another device on this port, or a wrong baud rate");
  EXPECT_EQ(b.count("bytes outside any message"), 300u);
}

TEST(MtiDriver, DamageIsCountedByCause) {
  Bench b;
  b.measure(50ms);
  b.say(from_hex(kWrongChecksum));
  b.say(from_hex(kWrongInnerSize));
  b.say(encode(mid::kMtData, {}));
  b.say(encode(0xEE, {}));
  b.wait(1s);
  EXPECT_EQ(b.count("message with a wrong checksum"), 1u);
  EXPECT_EQ(b.count("MTData2 with a packet that runs past its end"), 1u);
  EXPECT_EQ(b.count("MTData, the old format"), 1u);
  EXPECT_EQ(b.count("unknown message"), 1u);
}

TEST(MtiDriver, AMessageThatIsNeverFinishedDoesNotHoldUpTheNext) {
  Bench b;
  b.say({0xFA, 0xFF, 0x36, 0xF0});  // 240 bytes that do not come
  b.wait(600ms);
  b.measure(20ms);
  EXPECT_EQ(b.status().received, 2u);
}

TEST(MtiDriver, ALostLinkIsOpenedAgain) {
  Bench b;
  b.measure(50ms);
  b.driver_end->fail("the cable was pulled");
  b.wait(100ms);
  EXPECT_EQ(b.status().phase, Phase::Faulty);
  EXPECT_EQ(b.status().reason, "the cable was pulled");
  b.wait(1s);
  b.measure(50ms);
  EXPECT_EQ(b.status().phase, Phase::Up);
}

TEST(MtiDriver, WordsOfTheSettingsAreChecked) {
  EXPECT_TRUE(validate({}));
  EXPECT_EQ(validate({.heading = "north"}).error().fields.at(0).pointer, "heading");
  EXPECT_EQ(validate({.position = "ins"}).error().fields.at(0).pointer, "position");
}

}  // namespace
}  // namespace roverd::mti
