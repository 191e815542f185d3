// Any bytes as a stream whose own time paces a replay: marks go on, lie within what came, tell
// times that are some, and are the same wherever the stream is handed over in parts.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "gnss/stream_clock.hpp"
#include "mti/stream_clock.hpp"
#include "sick/stream_clock.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

struct Timed {
  std::uint64_t end;
  double s;
  friend bool operator==(const Timed&, const Timed&) = default;
};

std::vector<Timed> run(const base::StreamClock& clock, base::Bytes bytes, std::size_t piece) {
  std::vector<Timed> out;
  std::uint64_t last = 0;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    const std::size_t n = std::min(piece, bytes.size() - at);
    clock(bytes.subspan(at, n), [&](const base::StreamMark& mark) {
      check(mark.end >= last && mark.end <= at + n);
      last = mark.end;
      if (!mark.time) return;
      check(std::isfinite(mark.time->s) && mark.time->s >= 0.0);
      out.push_back({mark.end, mark.time->s});
    });
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const base::Bytes bytes(data + 1, size - 1);
  const std::size_t piece = data[0] % 64U + 1U;
  check(run(gnss::stream_clock(), bytes, bytes.size()) == run(gnss::stream_clock(), bytes, piece));
  check(run(mti::stream_clock(), bytes, bytes.size()) == run(mti::stream_clock(), bytes, piece));
  check(run(sick::stream_clock(), bytes, bytes.size()) == run(sick::stream_clock(), bytes, piece));
  return 0;
}
