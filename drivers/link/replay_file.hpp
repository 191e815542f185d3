#pragma once
// Recordings as a series of timed things, without a clock: what ReplayPump paces.

#include <cstdint>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"
#include "base/time.hpp"
#include "link/replay_options.hpp"

namespace roverd::link {

/// A file that is played item by item. Errors name the file and the line, or the byte.
class ReplayFile {
 public:
  virtual ~ReplayFile() = default;
  /// Loads the next item. @return when it is due, since the start of the file, never earlier than
  /// the item before; nothing at the end. A last line or record that was cut off counts as the end.
  virtual base::Result<std::optional<base::Duration>> advance() = 0;
  /// Hands the loaded item to its receiver.
  virtual void emit(base::Time now) = 0;
  /// Back to the first item.
  virtual base::Result<void> rewind() = 0;
  /// UTC since 1970 of the first stamp, once an item was loaded. Nothing without stamps of a date.
  std::optional<base::Duration> begin() const noexcept;

 protected:
  std::optional<base::Duration> first_stamp_;
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
  const std::string path_;
  const Receiver receiver_;
  std::ifstream file_;
  std::size_t line_ = 0;
  std::optional<base::Duration> last_stamp_;
  base::Duration at_{};
  base::CanFrame frame_;
};

/// A recording with stamps (recording.hpp), or any plain file. A plain one is played line by line,
/// timed by options.line_clock if that finds a time in the first 64 kB, else at the fallback rate;
/// its bytes arrive exactly as they stand in the file.
class ByteFile final : public ReplayFile {
 public:
  using Receiver = std::function<void(base::Bytes, base::Time)>;
  /// @param sent hears what the recording program sent; null: that is left out.
  ByteFile(std::string path, ReplayOptions options, Receiver receiver, Receiver sent = {});

  base::Result<void> open();
  base::Result<std::optional<base::Duration>> advance() override;
  void emit(base::Time now) override { (chunk_sent_ ? sent_ : receiver_)(chunk_, now); }
  base::Result<void> rewind() override;
  /// Stamps or the lines themselves tell when; false: what this is is not known. Once open.
  bool tells_time() const noexcept { return pace_ != Pace::Rated; }

 private:
  enum class Pace { Stamped, Clocked, Rated };

  base::Bytes rest() const noexcept { return base::Bytes(buffer_).subspan(begin_); }
  bool fill();
  void take(std::size_t bytes);
  bool has_line_clock() const;
  base::Result<std::optional<base::Duration>> advance_recording();
  std::optional<base::Duration> advance_plain();
  void wait_for(base::Bytes line);

  const std::string path_;
  const ReplayOptions options_;
  const Receiver receiver_;
  const Receiver sent_;
  std::ifstream file_;
  Pace pace_ = Pace::Rated;
  std::vector<std::uint8_t> buffer_;  // read from the file; played up to begin_
  std::size_t begin_ = 0;
  std::uint64_t offset_ = 0;  // of begin_ in the file
  std::vector<std::uint8_t> chunk_;
  bool chunk_sent_ = false;
  std::optional<base::Duration> last_stamp_;
  std::optional<double> last_clock_s_;
  base::Duration at_{};
};

}  // namespace roverd::link
