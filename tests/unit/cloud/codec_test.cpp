// Frames byte for byte, cut anywhere, damaged, too large.

#include "cloud/codec.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "frames.hpp"

namespace roverd::cloud {
namespace {

using Counts = std::map<std::string, std::uint64_t>;

struct Heard {
  explicit Heard(std::uint32_t max_points = kMaxPoints) : decoder(max_points) {}
  void feed(const Blob& bytes, std::size_t piece = 1'000'000) {
    for (Bytes rest(bytes); !rest.empty(); rest = rest.subspan(std::min(piece, rest.size()))) {
      decoder.feed(rest.first(std::min(piece, rest.size())),
                   [this](const Frame& f) { sequences.push_back(f.header.sequence); });
    }
  }
  Decoder decoder;
  std::vector<std::uint32_t> sequences;
};

TEST(CloudCodec, TheHeaderIsTheDocumentedOne) {
  Header h = header_of(7, 0x0102030405060708);
  h.pose = base::Mount{1.0, 2.0, 3.0, 0.1, 0.2, -0.5};
  h.optical = true;
  const Blob f = cloud_frame(h, {1.0F, 2.0F, 3.0F});
  ASSERT_EQ(f.size(), 56U + 8U + 12U);
  EXPECT_EQ(std::string(f.begin(), f.begin() + 4), "RVSC");
  EXPECT_EQ(f[4], 1);
  EXPECT_EQ(f[5], 1);
  EXPECT_EQ(f[6], 3);
  EXPECT_EQ(f[8], 8);
  EXPECT_EQ(f[15], 1);
  EXPECT_EQ(f[16], 7);
  EXPECT_EQ(f[20], 20);
  EXPECT_EQ(f32_at(f.data() + 24), 1.0F);
  EXPECT_EQ(f32_at(f.data() + 44), -0.5F);
  EXPECT_EQ(f32_at(f.data() + 68), 2.0F);
  const auto read = decode_header(f);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->stamp_ns, h.stamp_ns);
  ASSERT_TRUE(read->pose);
  EXPECT_NEAR(read->pose->pitch_rad, 0.2, 1e-7);
  EXPECT_TRUE(read->optical);
  EXPECT_TRUE(read->good);
}

TEST(CloudCodec, FramesOfEachKindComeOutHoweverTheStreamIsCut) {
  const Blob stream = cloud_frame(header_of(1), {1.0F, 0.0F, 0.0F}) +
                      depth_frame(header_of(2), 4, std::vector<std::uint16_t>(12, 1000)) +
                      ranges_frame(header_of(3), -1.0F, 0.5F, {1.0F, 2.0F}) +
                      cloud_frame(header_of(4), {});
  for (const std::size_t piece : {1U, 5U, 57U, 10'000U}) {
    Heard heard;
    heard.feed(stream, piece);
    EXPECT_EQ(heard.sequences, (std::vector<std::uint32_t>{1, 2, 3, 4})) << piece;
    EXPECT_TRUE(heard.decoder.refused().empty());
  }
}

TEST(CloudCodec, AfterRubbishAndDamageTheNextFrameIsFound) {
  const Blob good = cloud_frame(header_of(1), {1.0F, 0.0F, 0.0F});
  for (std::size_t at = 0; at < good.size(); ++at) {
    Blob damaged = good;
    damaged[at] ^= 0x40U;
    Heard heard;
    heard.feed(damaged + cloud_frame(header_of(2), {}) + cloud_frame(header_of(3), {}), 13);
    EXPECT_EQ(heard.sequences, (std::vector<std::uint32_t>{2, 3})) << "byte " << at;
    EXPECT_FALSE(heard.decoder.refused().empty());
  }
  Heard heard;
  heard.feed(Blob{'R', 'V', 'R', 'V', 'S', 'R'} + good + Blob(1000, 'R') + good, 3);
  EXPECT_EQ(heard.sequences.size(), 2U);
  EXPECT_EQ(heard.decoder.refused(), (Counts{{"bytes outside any frame", 1006}}));
  // A sender that broke off: what comes after it on a new connection.
  Heard again;
  again.feed(Blob(good.begin(), good.end() - 5));
  again.decoder.forget();
  again.feed(good);
  EXPECT_EQ(again.sequences.size(), 1U);
}

TEST(CloudCodec, SizesThatDoNotFitAreRefusedInWords) {
  const Blob one_point(12, 0);
  const Blob pixels(7, 0);
  Heard heard;
  heard.feed(encode(header_of(1), Cloud{2, 0.0F, one_point}));
  heard.feed(encode(header_of(1), Cloud{0, 0.0F, one_point}));
  heard.feed(encode(header_of(1), Depth{2, 2, 9.0F, 9.0F, 0.0F, 0.0F, 0.001F, pixels}));
  heard.feed(encode(header_of(1), Ranges{2, 0.0F, 0.1F, one_point}));
  EXPECT_TRUE(heard.sequences.empty());
  EXPECT_EQ(heard.decoder.refused(),
            (Counts{{"the body's size does not fit its number of points", 4}}));
}

TEST(CloudCodec, ValuesThatAreNoneAreRefusedInWords) {
  Heard heard;
  const Blob none;
  // What is no half angle: a hair, half a turn, none at all.
  for (const float half_rad : {kNan, -0.01F, 1e-9F, 9e-5F, 0.21F, 1.5F, kInfinity}) {
    heard.feed(encode(header_of(1), Cloud{0, half_rad, none}));
  }
  heard.feed(encode(header_of(1), Depth{0, 0, 0.0F, 100.0F, 0.0F, 0.0F, 0.001F, none}));
  heard.feed(encode(header_of(1), Depth{0, 0, 100.0F, kInfinity, 0.0F, 0.0F, 0.001F, none}));
  heard.feed(encode(header_of(1), Depth{0, 0, 100.0F, 100.0F, 0.0F, 0.0F, 0.0F, none}));
  heard.feed(encode(header_of(1), Ranges{0, 0.0F, 0.0F, none}));
  heard.feed(encode(header_of(1), Ranges{0, kNan, 0.1F, none}));
  Header tilted = header_of(1);
  tilted.pose = base::Mount{0.0, 0.0, std::nan(""), 0.0, 0.0, 0.0};
  heard.feed(cloud_frame(tilted, {}));
  heard.feed(cloud_frame(header_of(1, -5), {}));
  EXPECT_TRUE(heard.sequences.empty());
  const auto& refused = heard.decoder.refused();
  EXPECT_EQ(refused.at("half_step_rad of a cloud must be 0 or lie in 0.0001 .. 0.2"), 7U);
  EXPECT_EQ(refused.at("fx and fy of a depth image must be 1 or more"), 2U);
  EXPECT_EQ(refused.at("unit_m of a depth image must lie in 0.00001 .. 0.1"), 1U);
  EXPECT_EQ(refused.at("step_rad of ranges must lie in -3.2 .. 3.2 and not be 0"), 1U);
  EXPECT_EQ(refused.at("first_rad of ranges must lie in -7 .. 7"), 1U);
  EXPECT_EQ(refused.at("a pose that is none"), 1U);
  heard.feed(encode(header_of(7), Cloud{0, 0.0F, none}));
  heard.feed(encode(header_of(8), Cloud{0, 0.2F, none}));
  EXPECT_EQ(heard.sequences, (std::vector<std::uint32_t>{7, 8})) << "not known, and a wide one";
  EXPECT_EQ(refused.at("a stamp that is none"), 1U);
}

TEST(CloudCodec, TheBodyOfAHeaderThatIsRefusedIsLetByWithIt) {
  Heard heard;
  // Given a stamp that is none, before a body in which the letters of a header stand,
  const Blob letters = cloud_frame(header_of(9), {1.0F, 2.0F, 3.0F});
  std::vector<float> inside(60, 0.0F);
  std::memcpy(inside.data(), letters.data(), letters.size());
  heard.feed(cloud_frame(header_of(1, -5), inside) + cloud_frame(header_of(2), {1.0F, 1.0F, 1.0F}));
  // then it is refused once, and nothing of its body is taken for something else.
  EXPECT_EQ(heard.decoder.refused(), (Counts{{"a stamp that is none", 1}}));
  EXPECT_EQ(heard.sequences, (std::vector<std::uint32_t>{2}));
}

TEST(CloudCodec, ACloudOfTenMillionPointsIsLetByWithoutBeingKept) {
  const Blob huge = cloud_frame(header_of(1), std::vector<float>(30'000'000, 1.0F));
  Heard heard;
  heard.feed(huge, 65'536);
  heard.feed(cloud_frame(header_of(2), {1.0F, 1.0F, 1.0F}));
  EXPECT_EQ(heard.sequences, std::vector<std::uint32_t>{2});
  EXPECT_EQ(heard.decoder.refused(), (Counts{{"more than 1000000 points", 1}}));
}

TEST(CloudCodec, TheLimitHoldsForEachKind) {
  Heard heard(10);
  heard.feed(cloud_frame(header_of(1), std::vector<float>(33, 1.0F)));
  heard.feed(depth_frame(header_of(2), 4, std::vector<std::uint16_t>(12, 5)));
  heard.feed(ranges_frame(header_of(3), 0.0F, 0.1F, std::vector<float>(11, 1.0F)));
  EXPECT_TRUE(heard.sequences.empty());
  EXPECT_EQ(heard.decoder.refused(), (Counts{{"more than 10 points", 3}}));
  heard.feed(ranges_frame(header_of(4), 0.0F, 0.1F, std::vector<float>(10, 1.0F)));
  EXPECT_EQ(heard.sequences, std::vector<std::uint32_t>{4});
}

}  // namespace
}  // namespace roverd::cloud
