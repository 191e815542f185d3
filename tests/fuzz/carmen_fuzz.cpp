// Any bytes as a log of CARMEN, packed or not: the same scans however they are cut, and every pose
// finite.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "atlas/carmen.hpp"
#include "atlas/unpack.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

struct Told {
  std::uint64_t scans = 0;
  std::uint64_t beams = 0;
  std::uint64_t refused = 0;
  bool whole = true;
  friend bool operator==(const Told&, const Told&) = default;
};

Told run(base::Bytes bytes, std::size_t piece) {
  Told told;
  atlas::CarmenReader reader([&](const atlas::CarmenScan& s) {
    ++told.scans;
    told.beams += s.ranges_m.size();
    check(std::isfinite(s.odometry.x_m + s.odometry.y_m + s.odometry.yaw_rad + s.time_s));
  });
  std::size_t out = 0;
  atlas::Unpacker unpacker([&](base::Bytes b) {
    if (out += b.size(); out < 4'000'000) reader.feed(b);
  });
  for (std::size_t at = 0; at < bytes.size() && told.whole; at += piece) {
    told.whole = unpacker.feed(bytes.subspan(at, std::min(piece, bytes.size() - at))).has_value();
  }
  told.whole = unpacker.finish().has_value() && told.whole;
  reader.finish();
  told.refused = reader.refused();
  return told;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const base::Bytes bytes(data + 1, size - 1);
  const Told whole = run(bytes, std::max<std::size_t>(bytes.size(), 1));
  check(whole.beams <= whole.scans * atlas::CarmenReader::kMostBeams);
  const Told cut = run(bytes, data[0] % 64U + 1U);
  check(whole.whole == cut.whole && (!whole.whole || whole == cut));
  return 0;
}
