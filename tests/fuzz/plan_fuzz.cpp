// QGroundControl .plan files: whatever the bytes, an import is refused or gives a plan that can be
// written, read again and has the same positions.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "mission/formats/formats.hpp"
#include "mission/json/json.hpp"

using namespace roverd::mission;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto file = import_file(text, Format::Plan, text.substr(0, 20));
  if (!file) return file.error().detail.empty() ? std::abort(), 0 : 0;
  if (file->plan.items.empty()) return 0;  // a fence or an area alone
  const auto again = import_file(export_file(file->plan, Format::Plan).content, std::nullopt, "x");
  if (!again) std::abort();
  std::size_t at = 0;
  for (const Item& item : file->plan.items) {
    const auto* waypoint = std::get_if<Waypoint>(&item);
    if (waypoint == nullptr) continue;
    while (at < again->plan.items.size() &&
           !std::holds_alternative<Waypoint>(again->plan.items[at])) {
      ++at;
    }
    if (at == again->plan.items.size()) std::abort();
    if (std::get<Waypoint>(again->plan.items[at++]).at != waypoint->at) std::abort();
  }
  return 0;
}
