// Any bytes as what a WebSocket client says: the same texts are seen in whatever pieces they come,
// and none is longer than it may be.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "net/lookout.hpp"

namespace {

using roverd::net::Lookout;

std::vector<std::string> seen(std::string_view bytes, std::size_t piece) {
  std::vector<std::string> out;
  Lookout lookout;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    lookout.feed(bytes.substr(at, piece), [&](std::string_view text) {
      if (text.size() > Lookout::kLongest) std::abort();
      out.emplace_back(text);
    });
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data + 1), size - 1);
  if (seen(bytes, bytes.size()) != seen(bytes, data[0] % 16U + 1U)) std::abort();
  return 0;
}
