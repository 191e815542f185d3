// Bodies of the API: whatever the bytes, they are refused or give a plan that survives both of its
// text forms unchanged.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "mission/json/json.hpp"
#include "mission/json/quick_read.hpp"

using namespace roverd::mission;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto quick = quick_plan(text)) {
    const auto value = parse_json(text);
    if (!value || plan_from_json(*value) != *quick) std::abort();
  }
  const auto plan = plan_from_text(text);
  if (!plan) {
    // The answer must be writable as JSON.
    nlohmann::json answer{{"detail", plan.error().detail}};
    for (const auto& field : plan.error().fields) answer[field.pointer] = field.detail;
    return answer.dump().empty() ? std::abort(), 0 : 0;
  }
  if (!check_plan(*plan)) std::abort();
  if (plan_from_text(plan_to_text(*plan)) != *plan) std::abort();
  if (plan_from_text(plan_to_json(*plan).dump()) != *plan) std::abort();
  return 0;
}
