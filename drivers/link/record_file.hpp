#pragma once
// The files of one recording, one after the other:
//
//   20260301T120000Z-bunker.log, 20260301T120000Z-bunker.002.log, ….003.log, …
//
// A file that has reached its size is followed by the next, and the oldest goes when there are more
// than wanted. Text is written whole: no line or record begins in one file and ends in the next,
// and what a full disk took only in part is cut off again. The file that is being written is held
// by a shared flock().

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "base/result.hpp"
#include "base/time.hpp"

namespace roverd::link {

struct RecordOptions {
  /// Name of the bus in a candump log: letters and digits, "can0".
  std::string bus = "can0";
  /// What is lost at most if this program dies.
  base::Duration write_every = std::chrono::milliseconds(100);
  /// What is lost at most if the power fails.
  base::Duration sync_every = std::chrono::seconds(2);
  /// Of one file; the next begins before it would grow larger. A full 500 kbit/s bus fills the
  /// default in five minutes, a Bunker alone in an hour.
  std::uint64_t max_bytes = 64'000'000;
  /// Files of this recording that are kept; 1: recording stops when the first is full.
  int keep_files = 20;
  /// Recording stops rather than fill the disk on which missions are kept: with less left free.
  std::uint64_t keep_free_bytes = 200'000'000;
  /// Called once when recording had to stop, on the writer thread.
  std::function<void(const std::string& reason)> on_problem;
};

/// One thread; becomes unusable with a reason at the first error.
class RecordFile {
 public:
  /// Makes a new file; an existing one is never touched. @param header begins each file.
  static base::Result<std::unique_ptr<RecordFile>> create(const std::string& path,
                                                          const RecordOptions& options,
                                                          std::string header = {});
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  /// All of `text`, which ends with a whole line or record, or an error.
  base::Result<void> write(const std::string& text);
  /// To the disk itself; also looks how much room is left there.
  base::Result<void> sync();
  /// Bytes in all files of this recording, those that went included.
  std::uint64_t written() const noexcept { return written_; }

 private:
  RecordFile(std::string path, const RecordOptions& options, std::string header)
      : first_(std::move(path)),
        header_(std::move(header)),
        max_bytes_(options.max_bytes),
        keep_files_(options.keep_files),
        keep_free_bytes_(options.keep_free_bytes) {}
  base::Result<void> begin(const std::string& path);
  base::Result<void> follow();
  base::Result<void> put(const std::string& text);
  base::Result<void> stop(const std::string& why) const;

  const std::string first_;
  const std::string header_;
  const std::uint64_t max_bytes_;
  const int keep_files_;
  const std::uint64_t keep_free_bytes_;
  std::deque<std::string> paths_;  ///< oldest first; the last is being written
  int number_ = 1;
  int fd_ = -1;
  std::uint64_t size_ = 0;
  std::uint64_t written_ = 0;
};

/// "a/b.log", 2: "a/b.002.log". Pure.
std::string numbered_file(const std::string& first, int number);

}  // namespace roverd::link
