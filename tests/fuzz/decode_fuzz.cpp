// Any bytes to every reader of roverd decode: every object is one line of JSON that says something,
// and the same bytes in pieces give the same lines.

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include "tools/decode.hpp"

namespace {

using namespace roverd;

std::string lines(Reader (*make)(OnObject), base::Bytes bytes, std::size_t piece) {
  std::string out;
  const Reader reader = make([&out](const nlohmann::ordered_json& object) {
    const std::string line = to_line(object);
    if (line.find('\n') != line.size() - 1) std::abort();
    const auto again = nlohmann::ordered_json::parse(line, nullptr, false);
    if (!again.is_object() || again.size() < 2) std::abort();
    out += line;
  });
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(piece, bytes.size()))) {
    reader.feed(bytes.first(std::min(piece, bytes.size())));
  }
  reader.finish();
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const base::Bytes bytes(data + 2, size - 2);
  const std::size_t piece = data[0] % 64U + 1U;
  constexpr std::array kReaders{bunker_reader, nmea_reader,  ubx_reader,   mti_reader,
                                sick_reader,   vlp16_reader, vision_reader};
  const auto make = kReaders[data[1] % kReaders.size()];
  const std::string whole = lines(make, bytes, size);
  // Skipped bytes are told piece by piece.
  const std::string pieces = lines(make, bytes, piece);
  if (make == bunker_reader && whole != pieces) std::abort();
  return 0;
}
