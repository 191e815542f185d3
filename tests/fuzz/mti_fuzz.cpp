// Any bytes through framer and MTData2; cut elsewhere they give the same messages, and no number
// comes out that is none.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "mti/data2.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

void check_data(base::Bytes payload) {
  const mti::Data2 data = mti::decode_data2(payload);
  check(data.whole || data.packets.empty());
  for (const mti::Packet& p : data.packets) {
    const bool told = !std::holds_alternative<std::monostate>(p.value);
    check(told == (p.fault == mti::Fault::None));
    if (const auto* n = std::get_if<mti::Numbers>(&p.value)) {
      for (std::size_t i = 0; i < n->size; ++i) check(std::isfinite((*n)[i]));
    }
    if (const auto* pvt = std::get_if<mti::GnssPvt>(&p.value)) check(base::is_valid(pvt->at));
  }
}

std::uint64_t run(base::Bytes bytes, std::size_t piece) {
  mti::Framer framer;
  const auto take = [](const mti::Message& m) {
    check(m.payload.size() <= mti::kMaxPayload);
    if (m.mid == mti::mid::kMtData2) check_data(m.payload);
    mti::outputs_of(m.payload);
  };
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    framer.feed(bytes.subspan(at, std::min(piece, bytes.size() - at)), take);
  }
  framer.give_up(take);
  return framer.counts().messages;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const base::Bytes bytes(data + 1, size - 1);
  check(run(bytes, std::max<std::size_t>(bytes.size(), 1)) == run(bytes, data[0] % 64U + 1U));
  check_data(bytes);  // the checksum hides this from the fuzzer
  return 0;
}
