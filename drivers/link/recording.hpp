#pragma once
// Raw bytes of a stream with the time each chunk arrived: the file format. Pure functions.
//
//   roverd-bytes 1 serial:/dev/ttyACM0:115200⏎
//   (1700000000.123456) R 71⏎
//   $GNGGA,…\r\n⏎
//   (1700000000.323411) T 12⏎
//   …
//
// A header line with the version and where the bytes come from; then records. A record is a line
// with the stamp (UTC seconds since 1970, microseconds), R received or T sent, and the number of
// bytes; then the bytes themselves; then one line feed. So text streams stay readable, binary ones
// are kept exactly, a cut-off end costs the last record only, and damage in the middle is noticed
// at the next record and named by its byte offset.

#include <cstddef>
#include <string>
#include <string_view>

#include "base/bytes.hpp"
#include "base/time.hpp"

namespace roverd::link {

inline constexpr std::string_view kRecordingMagic = "roverd-bytes ";
inline constexpr std::size_t kLargestRecord = 65'536;  ///< bytes; longer chunks become several

struct ByteRecord {
  base::Duration stamp{};  ///< since 1970
  bool sent = false;
  base::Bytes bytes;  ///< of the parsed buffer; never empty
};

/// @param source free text; line ends in it become blanks.
std::string recording_header(std::string_view source);

/// Appends one record, or several if the chunk is larger than kLargestRecord. Nothing for no bytes.
void append_record(std::string& out, base::Duration stamp, bool sent, base::Bytes bytes);

/// value | need more | bad(reason)
struct RecordingStep {
  enum class State { Ok, NeedMore, Bad } state = State::NeedMore;
  std::size_t used = 0;  ///< bytes of the buffer that this step took
  ByteRecord record;     ///< of next_record
  std::string problem;   ///< of Bad
};

/// @param start the first bytes of a file, at least 1 kB or all of it.
RecordingStep read_recording_header(base::Bytes start);
/// @param rest where the previous step ended. NeedMore at the end of a file means it was cut off
/// there, or, if `rest` is empty, that it ended properly.
RecordingStep next_record(base::Bytes rest);

}  // namespace roverd::link
