// Any bytes through demultiplexer, parser, assemblers and the replay's clock; and the same bytes
// once more cut elsewhere must give the same sentences.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "gnss/decoder.hpp"
#include "gnss/epoch.hpp"
#include "gnss/gsv.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

void check_measurement(const base::Measurement& m) {
  if (const auto* fix = std::get_if<base::GnssFix>(&m); fix != nullptr && fix->position) {
    check(base::is_valid(*fix->position));
    check(fix->fix > base::FixType::Unknown);
  }
  if (const auto* v = std::get_if<base::GnssVelocity>(&m)) {
    check(!std::isnan(v->east_mps) && !std::isnan(v->north_mps));
  }
  if (const auto* h = std::get_if<base::Heading>(&m)) check(std::abs(h->yaw_rad) <= 3.1415926536);
}

gnss::SentenceCounts run(base::Bytes bytes, std::size_t chunk) {
  gnss::Decoder decoder;
  gnss::GsvAssembler satellites;
  gnss::EpochAssembler epochs({}, check_measurement);
  const auto sink = [&](const gnss::Sentence& s, base::Time t) {
    epochs.add(s, t);
    if (const auto* gsv = std::get_if<gnss::Gsv>(&s)) {
      if (const auto group = satellites.add(*gsv)) check(group->used <= group->sats.size());
    }
  };
  base::Time now{};
  for (std::size_t at = 0; at < bytes.size(); at += chunk) {
    now += std::chrono::milliseconds(1);
    decoder.feed(bytes.subspan(at, std::min(chunk, bytes.size() - at)), now, sink);
    epochs.tick(now);
  }
  decoder.give_up(now, sink);
  epochs.reset();
  return decoder.counts();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const base::Bytes bytes(data + 1, size - 1);
  const auto whole = run(bytes, std::max<std::size_t>(bytes.size(), 1));
  const auto pieces = run(bytes, data[0] % 64U + 1U);
  check(whole.used == pieces.used && whole.damaged == pieces.damaged);
  check(whole.unused == pieces.unused && whole.unknown == pieces.unknown);
  check(whole.ubx == pieces.ubx && whole.rtcm3 == pieces.rtcm3);
  gnss::time_of_day_s(bytes);
  gnss::parse_line({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  return 0;
}
