// Fences of the API: whatever the bytes, they are refused or give one that survives a round trip,
// and whose compiled form keeps to its word.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "mission/fence/fence_json.hpp"

using namespace roverd;

namespace {

base::LatLon near(const mission::Fence& fence) {
  for (const mission::FenceArea& area : fence.areas) {
    if (const auto* circle = std::get_if<mission::FenceCircle>(&area.shape)) return circle->center;
    return std::get<mission::FencePolygon>(area.shape).points.front();
  }
  return {58.0, 26.0};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto fence = mission::fence_from_text(text);
  if (!fence) return fence.error().detail.empty() ? std::abort(), 0 : 0;
  if (mission::fence_from_json(mission::fence_to_json(*fence)) != *fence) std::abort();
  const mission::CompiledFence limits(*fence, base::LocalFrame(1, near(*fence)));
  base::EnuPoint before{-7.5, 3.25};
  for (int i = 0; i < 16; ++i) {
    const base::EnuPoint p{std::cos(i) * 40.0 * i, std::sin(i) * 40.0 * i};
    const double room_m = limits.clearance_m(p);
    if (std::isnan(room_m) || (room_m > 0.0 && !limits.contains(p))) std::abort();
    limits.clearance_m(before, p);
    before = p;
  }
  return 0;
}
