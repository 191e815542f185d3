// Any bytes from a serial-line CAN adapter: no crash, no line longer than the limit, and what is
// read as a frame is one that CAN has and that is written and read back as the same.

#include <cstdint>
#include <cstdlib>
#include <vector>

#include "link/can_wire.hpp"
#include "link/slcan.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roverd::link;
  SlcanFramer framer;
  std::vector<SlcanFramer::Piece> pieces;
  // Two cuts: the framer must not care.
  const std::size_t cut = size == 0 ? 0 : data[0] % size;
  framer.feed({data, cut}, pieces);
  framer.feed({data + cut, size - cut}, pieces);
  for (const auto& piece : pieces) {
    if (piece.line.size() > SlcanFramer::kLongestLine) std::abort();
    const auto line = parse_slcan_line(piece.line);
    if (!line || line->kind != SlcanLine::Kind::Frame) continue;
    if (!is_valid(line->frame)) std::abort();
    const std::string again = to_slcan_line(line->frame);
    const auto twice = parse_slcan_line({again.data(), again.size() - 1});
    if (!twice || twice->frame != line->frame) std::abort();
  }
  return 0;
}
