#include "mti/stream_clock.hpp"

#include <memory>

#include "mti/data2.hpp"
#include "mti/xbus.hpp"

namespace roverd::mti {
namespace {

using base::StreamTime;

constexpr double kTick_s = 100e-6;
constexpr double kWrap_s = 4294967296.0 * kTick_s;

std::optional<StreamTime> time_of(const Message& message) {
  if (message.mid != mid::kMtData2) return {};
  const Data2 data = decode_data2(message.payload);
  if (!data.whole) return {};
  std::optional<StreamTime> utc;
  for (const Packet& packet : data.packets) {
    if (packet.fault != Fault::None) continue;
    if (packet.kind() == Kind::SampleTimeFine) {
      if (const auto* count = std::get_if<std::uint32_t>(&packet.value)) {
        return StreamTime{StreamTime::Clock::Samples, *count * kTick_s, kWrap_s};
      }
    }
    const auto* said = std::get_if<Utc>(&packet.value);
    if (said == nullptr || !said->time_valid()) continue;
    const int s = (said->hour * 60 + said->minute) * 60 + said->second;
    utc = StreamTime{StreamTime::Clock::TimeOfDay, s + said->nanosecond / 1e9};
  }
  return utc;
}

}  // namespace

base::StreamClock stream_clock() {
  return [framer = std::make_shared<Framer>()](base::Bytes bytes, const base::OnStreamMark& on) {
    // A message's end is known when the framer has gone past it.
    framer->feed(bytes, [&](const Message& m) { on({framer->position(), time_of(m)}); });
    on({framer->position(), {}});
  };
}

}  // namespace roverd::mti
