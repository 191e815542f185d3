// Any bytes through demultiplexer, parser, assemblers and the replay's clock; and the same bytes
// once more cut elsewhere must give the same sentences.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "gnss/blend.hpp"
#include "gnss/decoder.hpp"
#include "gnss/epoch.hpp"
#include "gnss/gsv.hpp"
#include "gnss/ubx_epoch.hpp"
#include "gnss/ubx_setup.hpp"

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

/// UBX messages and sentences as the driver hears them. The checksum hides most payloads from the
/// fuzzer, so the bytes are also taken as payloads themselves.
void run_both(base::Bytes bytes) {
  gnss::Blend blend(check_measurement);
  gnss::EpochAssembler sentences({}, [&](const base::Measurement& m) { blend.nmea(m); });
  gnss::UbxEpochs messages({.timeout_s = 0.25,
                            .baseline_m = 1.0,
                            .baseline_tolerance = 0.05,
                            .heading_offset_deg = 90.0},
                           [&](const base::Measurement& m) { blend.ubx(m); });
  gnss::UbxSetup setup({.configure = true});
  base::Time now{};
  struct Ears {
    gnss::EpochAssembler& sentences;
    gnss::UbxEpochs& messages;
    gnss::UbxSetup& setup;
    void operator()(const gnss::Sentence& s, base::Time t) const { sentences.add(s, t); }
    void operator()(const ubx::Message& m, base::Time t) const {
      setup.add(m);
      messages.add(m, t);
    }
  };
  const Ears ears{sentences, messages, setup};
  gnss::Decoder decoder;
  decoder.feed(bytes, now, ears);
  for (const ubx::Key key : {ubx::key::kNavPvt, ubx::key::kNavHpPosLlh, ubx::key::kNavCov,
                             ubx::key::kNavRelPosNed, ubx::key::kMonVer, ubx::key::kAckNak}) {
    now += std::chrono::milliseconds(10);
    setup.due(true, now);
    if (bytes.size() <= ubx::kMaxPayload) ears(ubx::decode({key, bytes}).message, now);
  }
  messages.tick(now + std::chrono::seconds(1));
  messages.reset();
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
  run_both(bytes);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto time_s = gnss::time_of_day_s(text);
  check(!time_s || (*time_s >= 0.0 && *time_s < 86'401.0));
  gnss::parse_line(text);
  return 0;
}
