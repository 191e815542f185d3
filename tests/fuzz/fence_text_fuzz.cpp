// ArduPilot's older fence and rally files: whatever the bytes, an import is refused in words or
// gives a fence that may be kept.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "mission/formats/formats.hpp"

using namespace roverd::mission;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  detect_format(text, text);
  const auto file = import_file(text, Format::Fence, "x");
  if (!file) return file.error().detail.empty() ? std::abort(), 0 : 0;
  if (!file->fence || !check_fence(*file->fence) || !file->plan.items.empty()) std::abort();
  return 0;
}
