// Captures: written and read back, in each byte order and link type, and ugly ones.

#include "pcap/pcap.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace roverd::pcap {
namespace {

using namespace std::chrono_literals;
using Blob = std::vector<std::uint8_t>;

constexpr Address kSensor{{192, 168, 1, 201}, 2368};
constexpr Address kRobot{{255, 255, 255, 255}, 2368};
const base::WallTime kWhen{std::chrono::seconds(1'673'400'471) + 737'763'166ns};

struct Seen {
  base::WallTime stamp;
  Address from;
  Address to;
  Blob payload;
};

struct Reading {
  std::vector<Seen> seen;
  Reader reader{[this](const Datagram& d) {
    seen.push_back({d.stamp, d.from, d.to, Blob(d.payload.begin(), d.payload.end())});
  }};
};

Blob operator+(Blob a, const Blob& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
Blob header() {
  const auto h = file_header();
  return {h.begin(), h.end()};
}

/// A header and records by hand, in either order.
struct Writer {
  bool big = false;
  Blob u16(unsigned v) const {
    Blob out{static_cast<std::uint8_t>(v & 0xFFU), static_cast<std::uint8_t>(v >> 8U)};
    if (big) std::reverse(out.begin(), out.end());
    return out;
  }
  Blob u32(std::uint32_t v) const {
    Blob out;
    for (unsigned i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(v >> 8U * i & 0xFFU));
    if (big) std::reverse(out.begin(), out.end());
    return out;
  }
  Blob file(std::uint32_t magic, std::uint32_t link_type) const {
    return u32(magic) + u16(2) + u16(4) + u32(0) + u32(0) + u32(65'535) + u32(link_type);
  }
  Blob record(std::uint32_t s, std::uint32_t fraction, const Blob& frame) const {
    const auto size = static_cast<std::uint32_t>(frame.size());
    return u32(s) + u32(fraction) + u32(size) + u32(size) + frame;
  }
};

/// The IP packet of a datagram, without pcap's headers.
Blob ip_of(const Blob& payload) {
  const Blob whole = record({kWhen, kSensor, kRobot, payload});
  return {whole.begin() + 16, whole.end()};
}
const Blob kEthernet{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x60, 0x76, 0x88, 1, 2, 3, 0x08, 0x00};
const Blob kTagged{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x60, 0x76, 0x88, 1,    2,
                   3,    0x81, 0x00, 0,    42,   0x81, 0,    0,    7,    0x08, 0x00};
const Blob kCooked{0, 1, 0, 1, 0, 6, 0x60, 0x76, 0x88, 1, 2, 3, 0, 0, 0x08, 0x00};
const Blob kCooked2{0x08, 0x00, 0, 0, 0, 0, 0, 2, 0, 1, 0, 6, 0x60, 0x76, 0x88, 1, 2, 3, 0, 0};

TEST(Pcap, WhatIsWrittenIsReadBackInPiecesOfAnySize) {
  Blob file = header();
  for (std::uint8_t i = 0; i < 5; ++i) {
    file = file + record({kWhen + i * 1ms, kSensor, kRobot, Blob(1206, i)});
  }
  for (const std::size_t piece : {1U, 7U, 1000U, 100'000U}) {
    Reading r;
    for (std::size_t at = 0; at < file.size(); at += piece) {
      ASSERT_TRUE(r.reader.feed(Bytes(file).subspan(at, std::min(piece, file.size() - at))));
    }
    EXPECT_TRUE(r.reader.finish());
    ASSERT_EQ(r.seen.size(), 5U);
    EXPECT_EQ(r.seen[3].stamp, kWhen + 3ms);
    EXPECT_EQ(r.seen[3].from, kSensor);
    EXPECT_EQ(r.seen[3].to, kRobot);
    EXPECT_EQ(r.seen[3].payload, Blob(1206, 3));
  }
  EXPECT_EQ(to_string(kSensor), "192.168.1.201:2368");
}

TEST(Pcap, TheIpHeaderCarriesTheChecksumOfTheStandard) {
  const Blob ip = ip_of({1, 2, 3, 4});
  ASSERT_EQ(ip.size(), 32U);
  EXPECT_EQ(ip[3], 32);
  EXPECT_EQ(ip[25], 12) << "UDP length";
  std::uint32_t sum = 0;  // RFC 1071: with its checksum a header adds up to FFFF
  for (std::size_t i = 0; i < 20; i += 2)
    sum += static_cast<std::uint32_t>(ip[i] << 8U | ip[i + 1]);
  EXPECT_EQ((sum & 0xFFFFU) + (sum >> 16U), 0xFFFFU);
}

TEST(Pcap, BothByteOrdersBothClocksEveryLinkType) {
  const Blob payload{9, 8, 7};
  struct Case {
    std::uint32_t link_type;
    Blob before;
  };
  for (const Case& c : {Case{1, kEthernet}, Case{1, kTagged}, Case{12, {}}, Case{101, {}},
                        Case{113, kCooked}, Case{228, {}}, Case{276, kCooked2}}) {
    for (const bool big : {false, true}) {
      const Writer w{big};
      Reading micro;
      EXPECT_TRUE(micro.reader.feed(w.file(0xA1B2C3D4, c.link_type) +
                                    w.record(10, 250'000, c.before + ip_of(payload))));
      ASSERT_EQ(micro.seen.size(), 1U) << c.link_type << " " << big;
      EXPECT_EQ(micro.seen[0].stamp.time_since_epoch(), 10'250ms);
      EXPECT_EQ(micro.seen[0].payload, payload);
      Reading nano;
      EXPECT_TRUE(nano.reader.feed(w.file(0xA1B23C4D, c.link_type) +
                                   w.record(10, 250'000, c.before + ip_of(payload))));
      ASSERT_EQ(nano.seen.size(), 1U);
      EXPECT_EQ(nano.seen[0].stamp.time_since_epoch(), 10s + 250us);
    }
  }
}

TEST(Pcap, FramesWithoutADatagramArePassedOverByCause) {
  const Writer w;
  Blob tcp = ip_of({1});
  tcp[9] = 6;
  Blob first_fragment = ip_of({1});
  first_fragment[6] = 0x20;
  Blob later_fragment = ip_of({1});
  later_fragment[7] = 1;
  Blob v6 = ip_of({1});
  v6[0] = 0x60;
  Blob cut = ip_of({1, 2, 3});
  cut.pop_back();
  Blob long_udp = ip_of({1});
  long_udp[25] = 200;
  Blob short_header = ip_of({1});
  short_header[0] = 0x44;
  Blob file = w.file(0xA1B2C3D4, 101);
  for (const Blob& frame :
       {tcp, first_fragment, later_fragment, v6, cut, long_udp, short_header, Blob{}}) {
    file = file + w.record(1, 1, frame);
  }
  Reading r;
  ASSERT_TRUE(r.reader.feed(file + w.record(1, 1, ip_of({5}))));
  ASSERT_EQ(r.seen.size(), 1U);
  const std::map<std::string, std::uint64_t> expected{
      {"not UDP", 1},   {"fragment", 2},           {"not IPv4", 1},
      {"cut short", 2}, {"a wrong UDP length", 1}, {"a wrong IP header", 1}};
  EXPECT_EQ(r.reader.passed_over(), expected);
  // An Ethernet frame of something else, and one that ends within a tag.
  Blob arp = kEthernet;
  arp[13] = 0x06;
  Reading ethernet;
  ASSERT_TRUE(ethernet.reader.feed(w.file(0xA1B2C3D4, 1) + w.record(1, 1, arp) +
                                   w.record(1, 1, {kTagged.begin(), kTagged.begin() + 17})));
  EXPECT_EQ(ethernet.reader.passed_over().at("not IPv4"), 1U);
  EXPECT_EQ(ethernet.reader.passed_over().at("cut short"), 1U);
}

std::string problem(const Blob& file) {
  Reading r;
  const auto fed = r.reader.feed(file);
  if (!fed) return fed.error().detail;
  const auto ended = r.reader.finish();
  return ended ? "" : ended.error().detail;
}

TEST(Pcap, AFractionBeyondASecondStaysWithinIt) {
  const Writer w;
  Reading r;
  ASSERT_TRUE(
      r.reader.feed(w.file(0xA1B2C3D4, 101) + w.record(0xFFFFFFFF, 0xFFFFFFFF, ip_of({1}))));
  ASSERT_EQ(r.seen.size(), 1U);
  EXPECT_EQ(r.seen[0].stamp.time_since_epoch(), 4'294'967'295s + 999'999'999ns);
}

TEST(Pcap, FilesThatAreNoneAreRefusedByByte) {
  const Writer w;
  EXPECT_EQ(problem({}), "byte 0: no header of a capture");
  EXPECT_EQ(problem(Blob(24, 0x55)), "byte 0: not the magic of a capture");
  EXPECT_EQ(problem(Blob{0x0A, 0x0D, 0x0D, 0x0A} + Blob(40, 0)).rfind("byte 0: pcapng", 0), 0U);
  EXPECT_EQ(problem(w.file(0xA1B2C3D4, 105)),
            "byte 20: link type 105 is not understood (1, 12, 101, 113, 228, 276 are)");
  EXPECT_EQ(problem(header() + Blob(15, 0)), "byte 24: the last record is cut");
  EXPECT_EQ(problem(header() + w.u32(0) + w.u32(0) + w.u32(0x7FFFFFFF) + w.u32(0)),
            "byte 32: a record of 2147483647 bytes");
  EXPECT_TRUE(begins_capture(header()));
  EXPECT_TRUE(begins_capture(Blob{0x0A, 0x0D, 0x0D, 0x0A}));
  EXPECT_FALSE(begins_capture(Blob{0xFF, 0xEE, 0, 0}));
  EXPECT_FALSE(begins_capture(Blob{0xA1}));
}

}  // namespace
}  // namespace roverd::pcap
