#include "gnss/stream_clock.hpp"

#include <algorithm>
#include <array>
#include <memory>

#include "gnss/framer.hpp"
#include "gnss/nmea.hpp"
#include "ubx/framer.hpp"

namespace roverd::gnss {
namespace {

using base::StreamTime;

constexpr double kWeek_s = 604'800.0;
constexpr std::uint8_t kNav = 0x01;

/// Navigation messages that begin with their iTOW, and those that have a version before it.
constexpr std::array<std::uint8_t, 19> kItowFirst{0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07,
                                                  0x11, 0x12, 0x20, 0x21, 0x22, 0x30, 0x32,
                                                  0x34, 0x35, 0x36, 0x43, 0x61};
constexpr std::array<std::uint8_t, 5> kVersionFirst{0x09, 0x13, 0x14, 0x3B, 0x3C};

std::optional<std::size_t> itow_at(std::uint8_t id) noexcept {
  if (std::ranges::find(kItowFirst, id) != kItowFirst.end()) return 0;
  if (std::ranges::find(kVersionFirst, id) != kVersionFirst.end()) return 4;
  return {};
}

std::optional<StreamTime> ubx_time(base::Bytes bytes) {
  const ubx::Frame frame = ubx::opened(bytes);
  if (frame.key.cls != kNav) return {};
  const auto at = itow_at(frame.key.id);
  if (!at || frame.payload.size() < *at + 4) return {};
  std::uint32_t itow_ms = 0;
  for (std::size_t i = 4; i-- > 0;) itow_ms = itow_ms << 8U | frame.payload[*at + i];
  const double s = itow_ms / 1e3;
  if (s >= kWeek_s) return {};
  return StreamTime{StreamTime::Clock::TimeOfWeek, s, kWeek_s};
}

std::optional<StreamTime> sentence_time(std::string_view text) {
  const auto s = time_of_day_s(text);
  if (!s) return {};
  return StreamTime{StreamTime::Clock::TimeOfDay, *s};
}

}  // namespace

base::StreamClock stream_clock() {
  return [framer = std::make_shared<Framer>()](base::Bytes bytes, const base::OnStreamMark& on) {
    framer->feed(bytes, Time{}, [&](const Cut& cut) {
      base::StreamMark mark{cut.end, {}};
      if (cut.piece == Piece::Ubx) mark.time = ubx_time(cut.bytes);
      if (cut.piece == Piece::Line) mark.time = sentence_time(cut.text);
      on(mark);
    });
    on({framer->position(), {}});
  };
}

}  // namespace roverd::gnss
