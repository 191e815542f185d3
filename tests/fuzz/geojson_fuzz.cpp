// GeoJSON files: whatever the bytes, an import is refused or gives a plan that can be written and
// read again.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "mission/formats/formats.hpp"

using namespace roverd::mission;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  detect_format(text);
  const auto file = import_file(text, Format::GeoJson, "x", {LatLon{58.378, 26.729}, false});
  if (!file) return file.error().detail.empty() ? std::abort(), 0 : 0;
  const Fence* fence = file->fence ? &*file->fence : nullptr;
  const auto again =
      import_file(export_file(file->plan, Format::GeoJson, fence).content, Format::GeoJson, "x");
  if (!again || again->plan.items.size() != file->plan.items.size()) std::abort();
  if (again->fence != file->fence) std::abort();
  return 0;
}
