// Any line: no crash, and what is read as a frame is one that CAN has and that is written and read
// back as the same.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "link/can_wire.hpp"
#include "link/candump.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto record = roverd::link::parse_candump_line({reinterpret_cast<const char*>(data), size});
  if (!record || !*record) return 0;
  auto once = **record;
  if (!roverd::link::is_valid(once.frame)) std::abort();
  // A log's stamps are whole microseconds, and it always has one.
  once.stamp = std::chrono::duration_cast<std::chrono::microseconds>(
      once.stamp.value_or(roverd::base::Duration{}));
  const auto twice = roverd::link::parse_candump_line(roverd::link::to_candump_line(once));
  if (!twice || !*twice || **twice != once) std::abort();
  return 0;
}
