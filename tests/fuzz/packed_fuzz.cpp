// What the database keeps of a revision: damaged bytes are refused or read, never worse.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "store/packed.hpp"

using namespace roverd::store;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::string_view prefix = bytes.substr(0, bytes.size() / 2);
  // A frame may tell a size that it does not have: that much is taken at most, and only for a
  // while.
  if (size < 4096) {
    (void)unpack(bytes);
    (void)unpack(bytes, prefix);
  }
  if (unpack(pack(bytes)).value() != bytes) std::abort();
  if (unpack(pack(bytes, prefix), prefix).value() != bytes) std::abort();
  return 0;
}
