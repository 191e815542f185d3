#pragma once
// Telegrams for tests: those of the scanner's fact sheet, and one to change.

#include <string>
#include <string_view>
#include <vector>

#include "sick/scan.hpp"

namespace roverd::sick {

inline constexpr std::string_view kShortScan =
    "sSN LMDscandata 1 1 B3C0DE 0 0 2A7 2AB 11A3F00D 11A4059F 0 0 7 0 0 1388 168 0 1 DIST1 "
    "3F800000 00000000 FFF92230 1388 5 3E8 0 5DC 12 4E20 0 0 0 0 0 0";
inline constexpr std::string_view kFullScan =
    "sSN LMDscandata 1 1 1234 0 0 1 1 1 2 0 0 0 0 0 9C4 168 1 FFFFFFFB A 2 DIST1 40000000 "
    "00000000 FFFF3CB0 9C4 4 7D0 7D1 7D2 7D3 RSSI1 3F800000 00000000 FFFF3CB0 9C4 4 78 0 FF FFFF "
    "0 0 1 A Front left 0 1 7EA 5 14 B 3B 2A 3D090 0";
inline constexpr std::string_view kPolledScan =
    "sRA LMDscandata 1 1 1234 0 0 1 1 1 2 0 0 0 0 0 1388 168 0 1 DIST1 3F800000 00000000 0 2710 2 "
    "1F4 258 1 RSSI1 3F800000 00000000 0 2710 2 A C8 0 0 0 0 0";

inline std::vector<std::uint8_t> bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}
/// With its frame.
inline std::vector<std::uint8_t> in_a(std::string_view text) {
  return frame(Dialect::A, bytes_of(text));
}
inline std::string text_of(Bytes bytes) {
  return {bytes.begin(), bytes.end()};
}
inline base::Result<Scan> decode_a(std::string_view text) {
  const auto body = bytes_of(text);
  return decode_scan({Dialect::A, body});
}
/// 541 beams from −45° by 0.5° at 50 Hz, all of them 2 m; sent 3.1 ms after its start.
inline Scan lms111(std::uint16_t number, std::uint32_t start_us) {
  Scan s;
  s.serial = 18090362;
  s.telegram_count = number;
  s.scan_count = number;
  s.start_us = start_us;
  s.sent_us = start_us + 3100;
  s.scan_frequency_chz = 5000;
  s.measuring_hhz = 360;
  s.channels = {{"DIST1", 16, 1.0F, 0.0F, -450'000, 5000, std::vector<std::uint16_t>(541, 2000)}};
  return s;
}

/// The bodies of all telegrams in these bytes, in pieces.
inline std::vector<std::string> bodies(Framer& framer, Bytes bytes, std::size_t piece) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    framer.feed(bytes.subspan(at, std::min(piece, bytes.size() - at)),
                [&](const Telegram& t) { out.push_back(text_of(t.body)); });
  }
  return out;
}

}  // namespace roverd::sick
