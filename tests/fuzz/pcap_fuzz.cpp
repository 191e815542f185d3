// Any bytes as a capture: the same datagrams however they are cut, each inside its file, and what
// is written of one is read as the same.

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "pcap/pcap.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

struct Told {
  std::uint64_t datagrams = 0;
  std::uint64_t bytes = 0;
  bool whole = false;
  friend bool operator==(const Told&, const Told&) = default;
};

void write_again(const pcap::Datagram& d) {
  bool read = false;
  pcap::Reader reader([&](const pcap::Datagram& again) {
    read =
        again.from == d.from && again.to == d.to && again.stamp == d.stamp &&
        std::equal(again.payload.begin(), again.payload.end(), d.payload.begin(), d.payload.end());
  });
  check(reader.feed(pcap::file_header()).has_value());
  check(reader.feed(pcap::record(d)).has_value() && read);
}

Told run(base::Bytes bytes, std::size_t piece, bool again) {
  Told told;
  pcap::Reader reader([&](const pcap::Datagram& d) {
    ++told.datagrams;
    told.bytes += d.payload.size();
    if (again) write_again(d);
  });
  told.whole = true;
  for (std::size_t at = 0; at < bytes.size() && told.whole; at += piece) {
    told.whole = reader.feed(bytes.subspan(at, std::min(piece, bytes.size() - at))).has_value();
  }
  told.whole = reader.finish().has_value();
  return told;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const base::Bytes bytes(data + 1, size - 1);
  const Told whole = run(bytes, std::max<std::size_t>(bytes.size(), 1), true);
  check(whole.bytes <= bytes.size());
  check(whole == run(bytes, data[0] % 64U + 1U, false));
  return 0;
}
