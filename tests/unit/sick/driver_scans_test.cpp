// What the scanner's driver makes of scans: which are taken, their times, and what it counts.

#include "unit/sick/bench.hpp"

namespace roverd::sick {
namespace {

TEST(SickDriverScans, GapsAreLostScansAndASecondCopyIsNone) {
  Bench b;
  b.number = 0xFFFD;
  b.scan(4);  // FFFE FFFF 0 1: the counter wraps
  EXPECT_EQ(b.count("lost scan"), 0u);
  b.say(encode(lms111(b.number, b.start_us), Dialect::A));
  EXPECT_EQ(b.count("scan that came twice"), 1u);
  EXPECT_EQ(b.seen.size(), 4u);
  b.number += 3;
  b.start_us += 60'000;
  b.scan(1);
  EXPECT_EQ(b.count("lost scan"), 3u);
  EXPECT_EQ(b.seen.back()->count, 7u);
  EXPECT_EQ(b.status().received, 5u);
  EXPECT_EQ(b.status().refused, 0u);
  EXPECT_EQ(b.status().detail->lost, 3u);
  EXPECT_EQ(b.status().detail->twice, 1u);
}

TEST(SickDriverScans, OfEachThirdScanNoneIsLost) {
  Bench b({.every = 3});
  for (int i = 0; i < 10; ++i) {
    b.number += 2;
    b.start_us += 40'000;
    b.scan(1);
  }
  EXPECT_EQ(b.count("lost scan"), 0u);
  EXPECT_EQ(b.seen.back()->count, 9u);
}

TEST(SickDriverScans, OneScanRepeatedForEverIsSilence) {
  Bench b;
  b.scan(1);
  for (int i = 0; i < 60; ++i) {
    b.say(encode(lms111(b.number, b.start_us), Dialect::A));
    b.wait(20ms);
  }
  EXPECT_EQ(b.status().phase, Phase::Faulty);
  EXPECT_EQ(b.seen.size(), 1u);
}

TEST(SickDriverScans, AnotherResolutionIsTakenAndTold) {
  Bench b;
  b.scan(2);
  Scan fine = lms111(static_cast<std::uint16_t>(b.number + 1), b.start_us + 40'000);
  fine.scan_frequency_chz = 2500;
  fine.channels[0].step_e4deg = 2500;
  fine.channels[0].values.assign(1081, 3000);
  b.say(encode(fine, Dialect::A));
  EXPECT_EQ(b.count("scan of another shape than before"), 1u);
  EXPECT_EQ(b.fact("scan"), "1081 beams of 0.25 deg from -45 deg, 25 Hz");
  EXPECT_EQ(b.seen.back()->points.size(), 1081u);
  EXPECT_NEAR(b.seen.back()->points.back().after_s, 0.030, 1e-6);
}

TEST(SickDriverScans, StampsAreAsEvenAsTheScannersClock) {
  Bench b;
  for (int i = 0; i < 200; ++i) {
    b.scan(1);
    if (i % 3 == 0) b.now += 4ms;  // some come late
    if (i % 3 == 1) b.now -= 4ms;
  }
  for (std::size_t i = 2; i < b.seen.size(); ++i) {
    const auto step = b.seen[i]->stamp - b.seen[i - 1]->stamp;
    EXPECT_NEAR(base::seconds(step), 0.020, 20e-6) << i;
  }
  // The last beam was measured before the telegram came.
  const auto& last = *b.seen.back();
  EXPECT_LE(base::seconds(last.stamp - b.now) + static_cast<double>(last.points.back().after_s),
            10e-6);
}

TEST(SickDriverScans, AClockThatStandsStillOrJumpsStopsNothing) {
  Bench b;
  b.scan(3);
  for (int i = 0; i < 5; ++i) {  // stands still, the counter goes on
    b.now += 20ms;
    Scan s = lms111(++b.number, 0);
    s.sent_us = 0;
    b.say(encode(s, Dialect::A));
    if (i == 0) continue;  // from 0xFFFFF67C to 0 it did go on
    EXPECT_NEAR(base::seconds(b.now - b.seen.back()->stamp), 0.015, 1e-3);
  }
  b.start_us += 500'000'000;
  b.scan(3);
  EXPECT_NEAR(base::seconds(b.now - b.seen.back()->stamp), 0.015, 1e-3);
  EXPECT_EQ(b.seen.size(), 11u);
}

TEST(SickDriverScans, AScannerThatIsNotWellIsHeardAndSaysSo) {
  Bench b;
  Scan s = lms111(1, 1000);
  s.status = {1, 0};
  b.say(encode(s, Dialect::A));
  EXPECT_EQ(b.status().phase, Phase::Up);
  EXPECT_FALSE(b.seen.back()->good);
  EXPECT_EQ(b.fact("status"), "starting");
  EXPECT_EQ(b.count("scan that the scanner does not vouch for"), 1u);
  s = lms111(2, 21'000);
  s.status = {0, 2};
  b.say(encode(s, Dialect::A));
  EXPECT_TRUE(b.seen.back()->good);
  EXPECT_EQ(b.seen.back()->window, base::Window::Dirty);
  EXPECT_EQ(b.fact("window"), "dirty");
  EXPECT_EQ(b.fact("status"), "pollution warning");
}

TEST(SickDriverScans, WhatIsNotBelievedIsCountedByItsCause) {
  Bench b;
  b.say(in_a("sSN LMDscandata 1 1 B3C0DE 0 0 2A7"));
  EXPECT_EQ(b.count("scan, scan counter: the telegram ends before it"), 1u);
  auto wrong = encode(lms111(1, 0), Dialect::B);
  wrong.back() ^= 1;
  b.say(wrong);
  EXPECT_EQ(b.count("telegram with a wrong checksum"), 1u);
  Scan s = lms111(1, 0);
  s.scan_frequency_chz = 0;
  b.say(encode(s, Dialect::A));
  EXPECT_EQ(b.count("scan with an impossible frequency"), 1u);
  b.say(in_a("sss"));
  EXPECT_EQ(b.count("telegram without words"), 1u);
  EXPECT_EQ(b.status().refused, 4u);
  EXPECT_TRUE(b.seen.empty());
  EXPECT_EQ(b.status().phase, Phase::Opening);
}

TEST(SickDriverScans, ATelegramThatIsNeverCompleteHidesNoOthers) {
  Bench b;
  auto cut = encode(lms111(1, 0), Dialect::B);
  cut[6] = 0x7F;  // says that it is much longer
  b.say(cut);
  b.scan(2, Dialect::B);
  EXPECT_TRUE(b.seen.empty());
  b.wait(600ms);
  EXPECT_EQ(b.seen.size(), 2u);
}

TEST(SickDriverScans, TellsItsRate) {
  Bench b;
  b.scan(100);
  EXPECT_NEAR(b.status().detail->rates_hz.at("scan"), 50.0, 3.0);
  EXPECT_EQ(b.fact("missing_returns"), "0 %");
}

}  // namespace
}  // namespace roverd::sick
