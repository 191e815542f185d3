#pragma once
// The scanner's driver over a memory link, and a scanner that a test speaks for.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "link/memory.hpp"
#include "sick/driver.hpp"
#include "unit/sick/words.hpp"

namespace roverd::sick {

using namespace std::chrono_literals;
using Phase = base::DriverPhase;

/// The driver with a scanner at the other end that a test speaks for.
struct Bench {
  explicit Bench(const Params& p = {})
      : wire(link::memory_byte_pair()),
        driver(
            "front", p,
            [this] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire.a)); },
            [](const base::Measurement&) {},
            [this](std::shared_ptr<const base::Sight> s) { seen.push_back(std::move(s)); }) {
    driver_end = wire.a.get();
    driver_end->set_immediate([this] { return now; });
    wire.b->set_immediate([this] { return now; });
    wire.b->on_bytes = [this](Bytes b, Time) {
      framer.feed(b, [this](const Telegram& t) {
        asked_in.push_back(t.dialect);
        const Words words = *words_of(t);
        asked.push_back(std::string(words.kind) + ' ' + std::string(words.name));
        if (t.dialect == Dialect::A) texts.push_back(text_of(t.body));
        if (answer) answer(t, words);
      });
    };
    EXPECT_TRUE(wire.b->open());
    driver.start(now);
  }

  void say(const std::vector<std::uint8_t>& bytes) { wire.b->write(bytes); }
  void wait(base::Duration d) {
    for (base::Duration t{}; t < d; t += 20ms) {
      now += 20ms;
      driver.tick(now);
    }
  }
  /// One scan each 20 ms, on an even clock.
  void scan(int n, Dialect d = Dialect::A) {
    for (int i = 0; i < n; ++i) {
      now += 20ms;
      ++number;
      start_us += 20'000;
      say(encode(lms111(number, start_us), d));
      driver.tick(now);
    }
  }
  /// A scanner that does all it is asked in this dialect and does not understand the other.
  void obey(Dialect d) {
    answer = [this, d](const Telegram& t, const Words& words) {
      if (t.dialect != d) return;
      const std::string name(words.name);
      if (words.kind == "sEN") return say(Writer(d, "sEA", name).u8(1).framed());
      if (words.kind == "sWN") return say(Writer(d, "sWA", name).framed());
      if (name == "STlms") return say(Writer(d, "sRA", name).u16(state).framed());
      if (words.kind == "sRN") return say(Writer(d, "sRA", name).word("LMS111", 6).framed());
      const bool says_one = name == "SetAccessMode" || name == "Run";
      say(Writer(d, "sAN", name).u8(says_one ? 1 : 0).framed());
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

  Time now{100s};
  link::MemoryBytePair wire;
  link::MemoryByteLink* driver_end = nullptr;
  Framer framer;
  std::vector<std::string> asked;
  std::vector<std::string> texts;
  std::vector<Dialect> asked_in;
  std::function<void(const Telegram&, const Words&)> answer;
  std::uint16_t state = 7;
  std::uint16_t number = 0;
  std::uint32_t start_us = 0xFFFF'0000;  // wraps after three scans
  std::vector<std::shared_ptr<const base::Sight>> seen;
  Driver driver;
};

}  // namespace roverd::sick
