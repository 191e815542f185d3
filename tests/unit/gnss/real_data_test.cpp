// Recordings of real receivers: every sentence is accounted for, and the track is theirs.

#include "../../real_data.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "gnss/decoder.hpp"
#include "gnss/epoch.hpp"

namespace roverd::gnss {
namespace {

using namespace std::chrono_literals;
using base::FixType;

struct Heard {
  SentenceCounts counts;
  Framer::Counts framing;
  std::vector<base::GnssFix> fixes;
  std::vector<base::GnssVelocity> velocities;

  std::vector<base::LatLon> track() const {
    std::vector<base::LatLon> out;
    for (const auto& fix : fixes) {
      if (fix.position) out.push_back(*fix.position);
    }
    return out;
  }
  std::map<FixType, int> by_fix() const {
    std::map<FixType, int> out;
    for (const auto& fix : fixes) ++out[fix.fix];
    return out;
  }
};

/// The whole file in chunks of this size.
Heard hear(const std::filesystem::path& path, std::size_t chunk) {
  Heard out;
  Decoder decoder;
  EpochAssembler epochs({}, [&](const base::Measurement& m) {
    if (const auto* fix = std::get_if<base::GnssFix>(&m)) out.fixes.push_back(*fix);
    if (const auto* v = std::get_if<base::GnssVelocity>(&m)) out.velocities.push_back(*v);
  });
  const auto data = tests::read_file(path);
  Time now{};
  const auto sink = [&](const Sentence& s, Time t) { epochs.add(s, t); };
  for (std::size_t at = 0; at < data.size(); at += chunk) {
    now += 1ms;
    decoder.feed(Bytes(data).subspan(at, std::min(chunk, data.size() - at)), now, sink);
  }
  decoder.give_up(now, sink);
  epochs.reset();
  out.counts = decoder.counts();
  out.framing = decoder.framing();
  EXPECT_EQ(out.framing.bytes, data.size());
  return out;
}

/// Positions of sentences, checksum-free, by the plainest means: a second opinion on the count.
std::size_t lines_beginning(const std::filesystem::path& path, std::string_view tag) {
  const auto data = tests::read_file(path);
  std::size_t n = 0;
  for (auto at = data.begin();;) {
    at = std::search(at, data.end(), tag.begin(), tag.end());
    if (at == data.end()) return n;
    ++n;
    at += static_cast<std::ptrdiff_t>(tag.size());
  }
}

TEST(RealData, ARtkReceiverIsUnderstoodCompletely) {
  ROVERD_REAL_DATA(path, "gnss-nmea-rtk.log");
  const Heard r = hear(path, 64);
  EXPECT_EQ(r.counts.used, 244u);
  EXPECT_EQ(r.counts.used, lines_beginning(path, "$G"));
  EXPECT_EQ(r.counts.unused + r.counts.unknown + r.counts.damaged, 0u);
  EXPECT_EQ(r.fixes.size(), 122u);
  EXPECT_EQ(r.velocities.size(), 122u);
  EXPECT_EQ(r.track().size(), 122u) << "every epoch has a fix";
  const auto by_fix = r.by_fix();
  EXPECT_TRUE(by_fix.contains(FixType::RtkFixed));
  EXPECT_TRUE(by_fix.contains(FixType::Differential));
  EXPECT_EQ(base::to_rfc3339(r.fixes.front().utc.value()), "2020-03-18T13:28:19.600Z");
  EXPECT_NEAR(r.track().front().lat, 41.0 + 34.49795459 / 60.0, 1e-10);
  EXPECT_NEAR(r.track().front().lon, -(93.0 + 45.03431408 / 60.0), 1e-10);
  EXPECT_EQ(r.fixes.front().geoid_sep_m, -31.442) << "negative in North America";
}

TEST(RealData, AConsumerReceiverWithoutGstMovesAndLosesItsFix) {
  ROVERD_REAL_DATA(path, "gnss-haicom-moving.log");
  const Heard r = hear(path, 64);
  EXPECT_EQ(r.counts.used, 325u);
  EXPECT_EQ(r.counts.used, lines_beginning(path, "$GP"));
  EXPECT_EQ(r.counts.unused + r.counts.unknown + r.counts.damaged, 0u);
  EXPECT_EQ(r.fixes.size(), 74u) << "one for each RMC, the first without GGA";
  const auto track = r.track();
  EXPECT_LT(track.size(), r.fixes.size()) << "it begins without a fix";
  EXPECT_GT(track.size(), 40u);
  double farthest_m = 0.0;
  for (const base::LatLon& p : track) {
    farthest_m = std::max(farthest_m, base::distance_bearing(track.front(), p).distance_m);
  }
  EXPECT_GT(farthest_m, 20.0);
  EXPECT_LT(farthest_m, 100.0);
  for (const auto& fix : r.fixes) {
    EXPECT_EQ(fix.sigma_east_m, std::nullopt);
    EXPECT_EQ(fix.position.has_value(), fix.fix != FixType::None);
  }
}

TEST(RealData, AReceiverThatMixesUbxAndNmeaIsDemultiplexed) {
  ROVERD_REAL_DATA(path, "gnss-zed-f9p-ubx-nmea.log");
  const Heard r = hear(path, 64);
  EXPECT_EQ(r.counts.ubx, 1963u);
  EXPECT_EQ(r.counts.used, 3u * 655u) << "RMC, VTG and GGA";
  EXPECT_EQ(r.counts.unused, 655u) << "GLL";
  EXPECT_EQ(r.counts.unknown, 0u);
  // The recording begins in the middle of a UBX frame, in which one byte looks like a beginning.
  EXPECT_EQ(r.counts.damaged, 1u);
  EXPECT_EQ(r.counts.by_flaw[static_cast<std::size_t>(Flaw::NotText)], 1u);
  EXPECT_EQ(r.framing.broken_binary, 0u);
  EXPECT_EQ(r.fixes.size(), 655u);
  // No course is ever printed. Up to 0.2 m/s that is standing; in 21 epochs it is more than that.
  EXPECT_EQ(r.velocities.size(), 634u);
  EXPECT_EQ(r.by_fix().at(FixType::Single), 655);
  EXPECT_EQ(base::to_rfc3339(r.fixes.front().utc.value()), "2019-04-12T01:19:03.000Z");
  for (const auto& v : r.velocities) {
    EXPECT_EQ(v.east_mps, 0.0);
    EXPECT_EQ(v.north_mps, 0.0);
  }
}

TEST(RealData, TheSizeOfTheChunksDoesNotMatter) {
  ROVERD_REAL_DATA(path, "gnss-zed-f9p-ubx-nmea.log");
  const Heard whole = hear(path, 1'000'000);
  for (const std::size_t chunk : {1u, 7u, 4096u}) {
    const Heard r = hear(path, chunk);
    EXPECT_EQ(r.counts.used, whole.counts.used) << chunk;
    EXPECT_EQ(r.counts.ubx, whole.counts.ubx) << chunk;
    EXPECT_EQ(r.counts.damaged, whole.counts.damaged) << chunk;
    EXPECT_EQ(r.track(), whole.track()) << chunk;
  }
}

}  // namespace
}  // namespace roverd::gnss
