// .waypoints files: whatever the bytes, an import is refused or gives a plan that can be written in
// either format and read again.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "mission/formats/formats.hpp"

using namespace roverd::mission;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  detect_format(text, text);
  const auto file = import_file(text, Format::Waypoints, "x.waypoints");
  if (!file) return file.error().detail.empty() ? std::abort(), 0 : 0;
  if (file->plan.items.empty()) return file->fence ? 0 : (std::abort(), 0);
  for (const Format format : {Format::Plan, Format::Waypoints}) {
    const auto again = import_file(export_file(file->plan, format).content, std::nullopt, "x");
    if (!again) std::abort();
    // What one round changed (reverse, speeds …) is in its final form after it.
    const auto third = import_file(export_file(again->plan, format).content, std::nullopt, "x");
    if (!third || third->plan != again->plan) std::abort();
  }
  return 0;
}
