#pragma once
// Recordings as a series of timed things, without a clock: what ReplayPump paces.

#include <array>
#include <cstdint>
#include <deque>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"
#include "base/time.hpp"
#include "link/replay_options.hpp"
#include "pcap/pcap.hpp"

namespace roverd::link {

/// A recording that is played item by item. One that goes on in X.002.log, X.003.log … beside X.log
/// is followed there, by its stamps. Errors name the file and the line, or the byte.
class ReplayFile {
 public:
  virtual ~ReplayFile() = default;
  ReplayFile(const ReplayFile&) = delete;
  ReplayFile& operator=(const ReplayFile&) = delete;
  /// Loads the next item. @return when it is due, since the start of the file, never earlier than
  /// the item before; nothing at the end. A last line or record that was cut off counts as the end.
  virtual base::Result<std::optional<base::Duration>> advance() = 0;
  /// Hands the loaded item to its receiver.
  virtual void emit(base::Time now) = 0;
  /// Back to the first item.
  virtual base::Result<void> rewind() = 0;
  /// UTC since 1970 of the first stamp, once an item was loaded. Nothing without stamps of a date.
  std::optional<base::Duration> begin() const noexcept;

  /// The recording's files, as far as they are there.
  static std::vector<std::string> parts_of(const std::string& first);

 protected:
  explicit ReplayFile(std::string path) : path_(std::move(path)), playing_(path_) {}
  base::Result<void> open_first();
  /// @return false: there is no further file.
  base::Result<bool> open_next();

  const std::string path_;
  std::string playing_;  ///< that file, or one that it goes on in
  std::ifstream file_;
  std::optional<base::Duration> first_stamp_;

 private:
  int number_ = 1;
};

/// A candump log or candump's console output (candump.hpp). Frames that the recorder marked as sent
/// are left out: the program that listens now was their sender then.
class FrameFile final : public ReplayFile {
 public:
  using Receiver = std::function<void(const base::CanFrame&, base::Time)>;
  FrameFile(std::string path, Receiver receiver);

  /// Opens and reads up to the first frame, so that a wrong file is noticed now.
  base::Result<void> open();
  base::Result<std::optional<base::Duration>> advance() override;
  void emit(base::Time now) override { receiver_(frame_, now); }
  base::Result<void> rewind() override;

 private:
  enum class Line { Frame, Skip, End };
  base::Result<Line> read_line();

  const Receiver receiver_;
  std::size_t line_ = 0;
  std::optional<base::Duration> last_stamp_;
  base::Duration at_{};
  base::CanFrame frame_;
};

/// A recording with stamps (recording.hpp), a capture of datagrams (pcap/pcap.hpp: each whole one,
/// whatever its addresses; an empty one is left out), or any plain file. A plain one is played
/// message by message, as options.make_clock cuts it, and timed by what the messages say if one in
/// the first 64 kB tells a time, else at the fallback rate; its bytes arrive exactly as they stand
/// in the file. A message that is late by less than kLate_s waits for nothing; a clock that is set
/// anew, or jumps by more than kSet_s, goes on from there.
class ByteFile final : public ReplayFile {
 public:
  using Receiver = std::function<void(base::Bytes, base::Time)>;
  /// @param sent hears what the recording program sent; null: that is left out.
  ByteFile(std::string path, ReplayOptions options, Receiver receiver, Receiver sent = {});

  base::Result<void> open();
  base::Result<std::optional<base::Duration>> advance() override;
  void emit(base::Time now) override { (chunk_sent_ ? sent_ : receiver_)(chunk_, now); }
  base::Result<void> rewind() override;
  /// Stamped: by a recorder. Clocked: by the device in its messages. Rated: not at all.
  enum class Pace { Stamped, Clocked, Rated };
  /// Once open.
  Pace pace() const noexcept { return pace_; }
  static constexpr double kLate_s = 10.0;
  static constexpr double kSet_s = 3600.0;

 private:
  struct Datagram {
    base::Duration stamp{};  ///< since 1970
    std::vector<std::uint8_t> bytes;
  };
  struct Reading {
    double s = 0.0;       ///< what that clock said last
    base::Duration at{};  ///< and when that was
  };

  base::Bytes rest() const noexcept { return base::Bytes(buffer_).subspan(begin_); }
  bool fill();
  void take(std::size_t bytes);
  base::Result<void> begin_file();
  base::Result<bool> follow();
  base::Result<void> begin_plain();
  base::Result<void> begin_capture();
  bool read_on();
  std::size_t next_piece(std::optional<base::StreamTime>& time);
  base::Result<std::optional<base::Duration>> advance_recording();
  base::Result<std::optional<base::Duration>> advance_capture();
  std::optional<base::Duration> advance_plain();
  void wait_for(const base::StreamTime& time);

  const ReplayOptions options_;
  const Receiver receiver_;
  const Receiver sent_;
  Pace pace_ = Pace::Rated;
  std::vector<std::uint8_t> buffer_;  // read from the file; played up to begin_
  std::size_t begin_ = 0;
  std::uint64_t offset_ = 0;  // of begin_ in the file
  std::optional<pcap::Reader> capture_;
  std::deque<Datagram> datagrams_;  ///< of what was read, not played yet
  std::vector<std::uint8_t> chunk_;
  bool chunk_sent_ = false;
  std::optional<base::Duration> last_stamp_;
  base::StreamClock clock_;
  std::deque<base::StreamMark> marks_;
  std::array<std::optional<Reading>, base::kStreamClocks> readings_;
  base::Duration at_{};
};

}  // namespace roverd::link
