// Files of a study: whatever the bytes, they are refused with a reason or give courses to drive.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "study/study.hpp"

using namespace roverd;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto courses = study::read_courses(
      text, [](const std::string& name) { return base::Result<std::string>(name); });
  if (!courses && courses.error().detail.empty()) std::abort();
  if (courses) {
    for (const study::Course& c : *courses) {
      if (!c.plan && c.points.size() < 2) std::abort();
    }
  }
  const auto disturbances = study::read_disturbances(text);
  if (!disturbances && disturbances.error().detail.empty()) std::abort();
  return 0;
}
