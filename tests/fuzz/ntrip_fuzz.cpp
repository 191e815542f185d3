// Any answer of a caster through the reply and the RTCM3 framer; cut elsewhere it is the same.

#include <algorithm>
#include <cstdlib>
#include <string>

#include "ntrip/caster.hpp"
#include "ntrip/digest.hpp"
#include "ntrip/reply.hpp"
#include "rtcm/crc24q.hpp"
#include "rtcm/framer.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

struct Outcome {
  ntrip::Reply reply;
  std::string data;
  std::uint64_t frames = 0;
};

Outcome run(base::Bytes bytes, std::size_t piece) {
  Outcome out;
  rtcm::Framer framer;
  const auto on_frame = [&](const rtcm::Frame& f) {
    check(f.bytes.size() <= rtcm::kMaxFrame && rtcm::crc24q(f.bytes) == 0);
    check(f.number >= 0 && f.number < 4096);
    ++out.frames;
  };
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    out.reply.feed(bytes.subspan(at, std::min(piece, bytes.size() - at)), [&](base::Bytes b) {
      out.data.append(b.begin(), b.end());
      framer.feed(b, on_frame);
    });
  }
  framer.give_up(on_frame);
  check(framer.counts().frames == out.frames);
  check(out.reply.sources().size() <= ntrip::Reply::kMaxSources);
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const base::Bytes bytes(data + 1, size - 1);
  const Outcome whole = run(bytes, std::max<std::size_t>(bytes.size(), 1));
  const Outcome pieces = run(bytes, data[0] % 64U + 1U);
  check(whole.data == pieces.data && whole.reply.state() == pieces.reply.state());
  check(whole.reply.refusal() == pieces.reply.refusal());
  // The same bytes as what a person wrote.
  const std::string text(bytes.begin(), bytes.end());
  if (const auto casters = ntrip::parse_casters(text)) {
    for (const auto& caster : *casters) {
      check(!caster.host.empty() && caster.port > 0);
      const std::string asked = ntrip::request(caster, 2);
      check(asked.find("\r\n\r\n") == asked.size() - 4);
    }
  }
  // And as a caster's wish for a Digest: what is sent back holds no line end.
  if (const auto challenge = ntrip::parse_challenge("Digest " + text)) {
    check(!challenge->nonce.empty());
    const auto answer = ntrip::digest_answer(*challenge, "rover:secret", "/M", "c");
    check(!answer || answer->find_first_of("\r\n") == std::string::npos);
    check(!answer || answer->find("secret") == std::string::npos ||
          text.find("secret") != std::string::npos);
  }
  return 0;
}
