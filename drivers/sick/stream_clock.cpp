#include "sick/stream_clock.hpp"

#include <memory>

#include "sick/scan.hpp"

namespace roverd::sick {
namespace {

using base::StreamTime;

constexpr double kSentTick_s = 1e-6;
constexpr double kSentWrap_s = 4294967296.0 * kSentTick_s;

std::optional<StreamTime> time_sent(const Telegram& telegram) {
  const auto words = words_of(telegram);
  if (!words || !is_scan(*words)) return {};
  const auto scan = decode_scan(telegram);
  if (!scan) return {};
  return StreamTime{StreamTime::Clock::Samples, scan->sent_us * kSentTick_s, kSentWrap_s};
}

}  // namespace

base::StreamClock stream_clock() {
  return [framer = std::make_shared<Framer>()](Bytes bytes, const base::OnStreamMark& on) {
    framer->feed(bytes, [&](const Telegram& t) { on({framer->position(), time_sent(t)}); });
    on({framer->position(), {}});
  };
}

}  // namespace roverd::sick
