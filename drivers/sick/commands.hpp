#pragma once
// What is said to a scanner besides scans, in both directions: requests for the driver, and their
// fields for whoever plays the scanner. Pure.
//
// Source: SICK, Telegram Listing Ranging Sensors (8014631).

#include <cstdint>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "sick/fields.hpp"

namespace roverd::sick {

/// mLMPsetscancfg, LMPscancfg. Angles in the scanner's own sense.
struct ScanConfig {
  std::uint32_t frequency_chz = 5000;  ///< 0.01 Hz
  std::uint16_t sectors = 1;
  std::uint32_t step_e4deg = 5000;
  std::int32_t start_e4deg = -450'000;
  std::int32_t stop_e4deg = 2'250'000;
  friend bool operator==(const ScanConfig&, const ScanConfig&) = default;
};
/// LMPoutputRange.
struct OutputRange {
  std::uint16_t sectors = 1;
  std::uint32_t step_e4deg = 5000;
  std::int32_t start_e4deg = -450'000;
  std::int32_t stop_e4deg = 2'250'000;
  friend bool operator==(const OutputRange&, const OutputRange&) = default;
};
/// LMDscandatacfg: what a scan telegram holds.
struct DataConfig {
  std::uint16_t echoes = 0x0100;  ///< high byte: one bit an echo, the first lowest
  bool remission = true;
  bool remission_16_bit = true;
  std::uint8_t unit = 0;       ///< digits
  std::uint16_t encoders = 0;  ///< high byte: one bit an encoder
  bool position = false;
  bool name = false;
  bool comment = false;
  bool time = false;
  std::uint16_t every = 1;  ///< each, each second, … scan
  friend bool operator==(const DataConfig&, const DataConfig&) = default;
};

/// The hash of the factory's password of level 3, "client".
inline constexpr std::uint32_t kClientPassword = 0xF472'4744;

using Request = std::vector<std::uint8_t>;  ///< with its frame

Request login(Dialect d);
/// sRN. @param name "STlms", "DeviceIdent", "LMPscancfg", "LMDscandata" …
Request read(Dialect d, std::string_view name);
/// sMN without fields. @param name "LMCstartmeas", "LMCstopmeas", "Run", "mEEwriteall"
Request call(Dialect d, std::string_view name);
Request set(Dialect d, const ScanConfig& config);
Request set(Dialect d, const OutputRange& range);
Request set(Dialect d, const DataConfig& config);
/// Scans come, or come no more.
Request subscribe(Dialect d, bool on);

/// The fields alone, of a request or of an answer; errors as decode_scan.
ScanConfig read_scan_config(Fields& in);
OutputRange read_output_range(Fields& in);
DataConfig read_data_config(Fields& in);
void write(Writer& out, const ScanConfig& config);
void write(Writer& out, const OutputRange& range);
void write(Writer& out, const DataConfig& config);

/// What an answer says about its request. @param words of it. Empty: it was done. Otherwise why
/// not: "refused", "resolution error", "access denied".
std::string_view refusal_in(const Telegram& answer, const Words& words) noexcept;

/// Of an answer to STlms: 0 undefined … 7 ready for measurement. Only the first field is read.
base::Result<int> state_in(const Telegram& answer, const Words& words);
std::string_view state_words(int state) noexcept;
inline constexpr int kMeasuring = 7;

/// The letters of an answer to DeviceIdent, SerialNumber, FirmwareVersion: printable ASCII, at most
/// 64 characters, the lengths between them left out.
std::string letters_in(const Telegram& answer, const Words& words);

}  // namespace roverd::sick
