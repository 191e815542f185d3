// Any bytes through framer and messages; cut elsewhere they give the same frames, and what is
// written again is what was read.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "ubx/messages.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

void on_frame(const ubx::Frame& frame) {
  check(frame.payload.size() <= ubx::kMaxPayload);
  const auto again = ubx::encode(frame.key, frame.payload);
  check(ubx::is_intact(again));
  const ubx::Decoded decoded = ubx::decode(frame);
  if (const auto* pvt = std::get_if<ubx::NavPvt>(&decoded.message)) {
    check(base::is_valid(pvt->at));
    check(pvt->usable() == (pvt->quality() > 0));
  }
  if (const auto* sig = std::get_if<ubx::NavSig>(&decoded.message)) {
    check(sig->all.size() * 16 + 8 <= frame.payload.size());
  }
  if (const auto* rel = std::get_if<ubx::NavRelPosNed>(&decoded.message)) {
    check(!rel->heading_usable(1.0, 0.05) || std::isfinite(rel->heading_deg));
  }
  if (const auto* set = std::get_if<ubx::ValSet>(&decoded.message)) {
    check(ubx::is_intact(ubx::encode(*set)));
  }
}

ubx::Framer::Counts run(base::Bytes bytes, std::size_t piece) {
  ubx::Framer framer;
  std::size_t others = 0;
  const auto on_other = [&](base::Bytes b) { others += b.size(); };
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    framer.feed(bytes.subspan(at, std::min(piece, bytes.size() - at)), on_frame, on_other);
  }
  framer.give_up(on_frame, on_other);
  check(others == framer.counts().other_bytes);
  return framer.counts();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const base::Bytes bytes(data + 1, size - 1);
  const auto whole = run(bytes, std::max<std::size_t>(bytes.size(), 1));
  const auto pieces = run(bytes, data[0] % 64U + 1U);
  check(whole.frames == pieces.frames && whole.other_bytes == pieces.other_bytes);
  // The rest as a payload of a known message: the checksum hides these paths from the fuzzer.
  constexpr std::array kKeys{ubx::key::kNavPvt,    ubx::key::kNavHpPosLlh,  ubx::key::kNavCov,
                             ubx::key::kMonVer,    ubx::key::kNavRelPosNed, ubx::key::kAckAck,
                             ubx::key::kCfgValSet, ubx::key::kNavSat,       ubx::key::kNavSig};
  if (bytes.size() <= ubx::kMaxPayload) on_frame({kKeys[data[0] % kKeys.size()], bytes});
  return 0;
}
