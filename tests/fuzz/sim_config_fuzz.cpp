// The simulator's configuration file: any text is taken whole or refused with a reason.

#include <cstdlib>
#include <string_view>

#include "sim/config.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  roverd::sim::Config config;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto done = roverd::sim::read_config(config, text, "fuzz.toml");
  if (!done && done.error().detail.empty()) std::abort();
  return 0;
}
