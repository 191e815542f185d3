// Any text as lines of ranges: the same lines however they are cut, every range positive and
// finite, every point finite.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "ranges/fan.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

std::size_t run(base::Bytes bytes, std::size_t piece, const ranges::Fans& fans) {
  ranges::Lines lines;
  std::size_t told = 0;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    lines.feed(
        bytes.subspan(at, std::min(piece, bytes.size() - at)),
        [&](std::string_view text) {
          check(text.size() <= ranges::kLongestLine);
          const ranges::Line line = ranges::parse(text, 0.01);
          if (line.fault != nullptr) return;
          ++told;
          check(!line.readings.empty() && line.readings.size() <= ranges::kMostRanges);
          for (const ranges::Reading& r : line.readings) {
            const bool range = r.outcome == ranges::Outcome::Range;
            check(range ? r.range_m > 0.0 && std::isfinite(r.range_m) : r.range_m == 0.0);
          }
          base::Sight sight;
          fans.spread(line.readings, sight);
          for (const auto& p : sight.points) check(std::isfinite(p.x_m) && std::isfinite(p.y_m));
        },
        [] {});
  }
  return told;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const base::Bytes bytes(data + 1, size - 1);
  ranges::Params params;
  params.count = 4;
  // The lists are foreign text, too.
  params.bearings_deg.assign(bytes.begin(),
                             bytes.begin() + std::min<std::ptrdiff_t>(20, std::ssize(bytes)));
  static_cast<void>(ranges::validate(params));
  const ranges::Fans fans(params);
  check(run(bytes, std::max<std::size_t>(bytes.size(), 1), fans) ==
        run(bytes, data[0] % 16U + 1U, fans));
  return 0;
}
