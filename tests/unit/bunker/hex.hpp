#pragma once
// Frames as the fact sheet writes them.

#include <sstream>
#include <string>

#include "base/bytes.hpp"

namespace roverd::bunker {

/// "00 96 …"
inline base::CanFrame frame(std::uint32_t frame_id, const std::string& hex) {
  base::CanFrame f;
  f.id = frame_id;
  std::istringstream in(hex);
  for (int byte = 0; in >> std::hex >> byte;) f.data[f.len++] = static_cast<std::uint8_t>(byte);
  return f;
}

}  // namespace roverd::bunker
