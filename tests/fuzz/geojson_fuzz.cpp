// GeoJSON files: whatever the bytes, an import is refused or gives a plan that can be written and
// read again.

#include <cstddef>
#include <cstdint>

#include "track_round.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  roverd::mission::fuzz_track_file({reinterpret_cast<const char*>(data), size},
                                   roverd::mission::Format::GeoJson);
  return 0;
}
