// Lines of the simulator's side channel: any bytes give exactly one line as an answer.

#include <cstdlib>
#include <string_view>

#include "sim/bunker.hpp"
#include "sim/control.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static roverd::sim::Bunker bunker({}, 1, {});
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  const auto answer = roverd::sim::carry_out(line, bunker, {});
  if (answer.line.empty() || answer.line.find('\n') != std::string::npos) std::abort();
  bunker.advance_to(bunker.truth().time + roverd::sim::Bunker::kStep);
  return 0;
}
