// Any bytes as a file of map tiles: described and read within the time that it may take, or
// refused.

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "store/tiles.hpp"

namespace {

void check(bool truth) {
  if (!truth) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roverd::store;
  static const auto file = std::filesystem::temp_directory_path() /
                           ("roverd-tiles-fuzz-" + std::to_string(::getpid()) + ".mbtiles");
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  if (const auto opened = TileFile::open("any", file)) {
    const TileSet& about = (*opened)->about();
    check(about.min_zoom >= 0 && about.max_zoom <= kMostZoom);
    if (about.bounds_deg) {
      for (const double edge_deg : *about.bounds_deg) check(std::abs(edge_deg) <= 180.0);
    }
    (void)(*opened)->read({about.max_zoom, 0, 0});
    (void)(*opened)->empty();
  }
  std::filesystem::remove(file);
  return 0;
}
