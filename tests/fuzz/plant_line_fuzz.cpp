// What somebody else's plant answers: whatever the bytes, they are refused with a reason or give a
// state within bounds.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "study/plant_line.hpp"

using namespace roverd;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  for (const bool first : {true, false}) {
    const auto said = study::read_plant_line(line, {}, first);
    if (!said && said.error().detail.empty()) std::abort();
    if (!said) continue;
    const sim::ForeignState& s = said->state;
    if (!(std::abs(s.at.east_m) < 1e4) || !std::isfinite(s.yaw_rad)) std::abort();
    if (!(std::abs(s.left_mps) < 1e4) || !(std::abs(s.right_mps) < 1e4)) std::abort();
  }
  return 0;
}
