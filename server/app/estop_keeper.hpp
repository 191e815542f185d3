#pragma once
// The latched emergency stop outlives this process: killed, crashed or without power, it is latched
// again before the control loop of the next one begins.
//
//   control thread ──want()──▶ semaphore ──▶ this thread ──write──▶ page cache ──sync──▶ disk
//                                                          └─▶ when_kept: survives SIGKILL
//
// One small file, held open, always overwritten in place by a text of the same length: it needs
// neither room nor a descriptor when it matters. Only two texts are good. Whatever else stands
// there (a cut write, a foreign file) counts as latched, and so does a file that should be there
// and is not: a person looks then. The control loop never waits for any of it.

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <semaphore.h>

namespace roverd {

/// The file's whole text.
std::string_view estop_text(bool latched) noexcept;
/// Empty: it is neither of the two texts.
std::optional<bool> estop_from(std::string_view text) noexcept;

class EstopKeeper {
 public:
  struct Found {
    bool latched = false;
    std::string why;  ///< of latched: a sentence for people
  };
  struct Callbacks {
    /// Keeper's thread, once for each trouble: the state cannot be written.
    std::function<void(const std::string& why)> trouble;
  };

  /// Reads what there is, and begins to keep. What can be neither read nor made counts as latched,
  /// too, and nothing is kept then. @param first this data folder is new: no file is no surprise
  static std::unique_ptr<EstopKeeper> open(const std::filesystem::path& file, bool first,
                                           Callbacks callbacks);
  /// Writes what is still to be written.
  ~EstopKeeper();
  EstopKeeper(const EstopKeeper&) = delete;
  EstopKeeper& operator=(const EstopKeeper&) = delete;

  const Found& found() const noexcept { return found_; }

  /// Control thread: never waits, allocates nothing.
  void want(bool latched) noexcept;
  /// Any thread. `then` is called on the keeper's thread as soon as what was wanted
  /// before survives the end of this process; also when that cannot be had.
  void when_kept(std::function<void()> then);

 private:
  EstopKeeper(int fd, std::filesystem::path file, Found found, Callbacks callbacks);
  void run() noexcept;
  void keep(bool latched);
  void tell(const char* deed, int error);

  const int fd_;  ///< -1: it cannot be had
  const std::filesystem::path file_;
  const Found found_;
  const Callbacks callbacks_;
  sem_t news_{};
  std::atomic<bool> wanted_;
  std::atomic<bool> stop_{false};
  std::mutex mutex_;                            // leaf
  std::vector<std::function<void()>> waiting_;  ///< guarded by mutex_
  bool troubled_ = false;                       ///< told, and not over
  std::thread thread_;
};

}  // namespace roverd
