// Any file: no crash, no step beyond the end, no step that stands still; and every record read is
// written and read back as the same.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "link/recording.hpp"

namespace {

using roverd::base::Bytes;
using State = roverd::link::RecordingStep::State;

void check(bool ok) {
  if (!ok) std::abort();
}

void check_round_trip(const roverd::link::ByteRecord& record) {
  std::string text;
  roverd::link::append_record(text, record.stamp, record.sent, record.bytes);
  const auto again = roverd::link::next_record(
      Bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  check(again.state == State::Ok && again.used == text.size());
  check(again.record.stamp == record.stamp && again.record.sent == record.sent);
  check(std::ranges::equal(again.record.bytes, record.bytes));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes rest(data, size);
  const auto header = roverd::link::read_recording_header(rest);
  if (header.state == State::Ok) {
    check(header.used > 0 && header.used <= rest.size());
    rest = rest.subspan(header.used);
  }
  for (;;) {
    const auto step = roverd::link::next_record(rest);
    if (step.state != State::Ok) return 0;
    check(step.used > 0 && step.used <= rest.size() && !step.record.bytes.empty());
    check_round_trip(step.record);
    rest = rest.subspan(step.used);
  }
}
