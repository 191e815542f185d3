// Any bytes through the parsers of the drive links and the bumper, whole and cut elsewhere.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "ackermann/codec.hpp"
#include "bumper/codec.hpp"
#include "ratio/codec.hpp"
#include "twist/binary.hpp"
#include "twist/text.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

/// What a decoder makes of the bytes, as text, fed in pieces of `chunk`.
template <class Decoder, class Show>
std::string run(base::Bytes bytes, std::size_t chunk, Show&& show) {
  Decoder decoder;
  std::string all;
  for (std::size_t at = 0; at < bytes.size(); at += chunk) {
    decoder.feed(bytes.subspan(at, std::min(chunk, bytes.size() - at)),
                 [&](const auto& message) { all += show(message); });
  }
  return all + std::to_string(decoder.refused());
}

template <class Decoder, class Show>
void both(base::Bytes bytes, std::size_t chunk, Show&& show) {
  check(run<Decoder>(bytes, std::max<std::size_t>(bytes.size(), 1), show) ==
        run<Decoder>(bytes, chunk, show));
}

std::string show_said(const twist::Said& said) {
  if (const auto* c = std::get_if<twist::Command>(&said)) {
    check(std::isfinite(c->speed_mps) && std::isfinite(c->turn_radps));
    return twist::encode_text(*c);
  }
  const auto& f = std::get<twist::Feedback>(said);
  check(std::isfinite(f.speed_mps) && std::isfinite(f.left_m));
  return twist::encode_text(f);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const base::Bytes bytes(data + 1, size - 1);
  const std::size_t chunk = data[0] % 32U + 1U;
  const auto d = ackermann::decode(bytes);
  if (d.fault == ackermann::Fault::None) {
    const auto again = ackermann::encode(d.message);
    check(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()));
  }
  both<bumper::Decoder>(bytes, chunk, [](std::uint8_t mask) { return bumper::encode(mask); });
  both<ratio::Decoder>(bytes, chunk, [](const ratio::Message& m) {
    check(std::isfinite(m.speed_mps) && std::abs(m.ratio) <= 2.0);
    return std::to_string(m.speed_mps) + " " + std::to_string(m.ratio) + ";";
  });
  both<twist::TextDecoder>(bytes, chunk, show_said);
  both<twist::BinaryDecoder>(bytes, chunk, show_said);
  return 0;
}
