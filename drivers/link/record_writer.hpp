#pragma once
// Writing a recording beside the device thread and the control loop. Neither may wait for a disk
// (an SD card pauses for hundreds of milliseconds), so they put entries into rings, one for each,
// and a thread of the recorder's own turns them into text and writes it.
//
//   device thread ──▶ ring ─┐
//   control thread ─▶ ring ─┴─▶ writer thread: sorted by time, formatted, written, synced
//
// A full ring drops the new entry and counts it. When the disk is full or gone, recording stops for
// good, with the reason; the link goes on without it.

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/result.hpp"
#include "base/time.hpp"
#include "link/record_file.hpp"

namespace roverd::link {

struct RecordStatus {
  std::uint64_t received = 0;  ///< entries of each direction put into the file
  std::uint64_t sent = 0;
  std::uint64_t dropped = 0;  ///< the writer was too slow, or recording had stopped
  std::uint64_t bytes = 0;    ///< written to the file
  std::string problem;        ///< why recording stopped; empty while it goes on
};

/// One producer thread, one consumer thread, no waiting, no allocation of its own.
template <class T>
class Ring {
 public:
  explicit Ring(std::size_t capacity) : slots_(capacity + 1) {}

  /// Producer. @return false when full; `value` is then lost.
  bool put(T value) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    const std::size_t next = (head + 1) % slots_.size();
    if (next == tail_.load(std::memory_order_acquire)) return false;
    slots_[head] = std::move(value);
    head_.store(next, std::memory_order_release);
    return true;
  }

  /// Consumer. Appends what there is.
  void take(std::vector<T>& out) {
    std::size_t tail = tail_.load(std::memory_order_relaxed);
    const std::size_t head = head_.load(std::memory_order_acquire);
    while (tail != head) {
      out.push_back(std::move(slots_[tail]));
      tail = (tail + 1) % slots_.size();
    }
    tail_.store(tail, std::memory_order_release);
  }

 private:
  std::vector<T> slots_;
  std::atomic<std::size_t> head_{0};
  std::atomic<std::size_t> tail_{0};
};

/// @tparam Entry has `base::Time stamp` and `bool sent`.
template <class Entry>
class RecordWriter {
 public:
  /// Appends the text of one entry. @param stamp UTC since 1970. Called on the writer thread.
  using Format = std::function<void(std::string& out, const Entry& entry, base::Duration stamp)>;

  RecordWriter(std::unique_ptr<RecordFile> file, Format format, RecordOptions options,
               std::size_t capacity)
      : file_(std::move(file)),
        format_(std::move(format)),
        options_(std::move(options)),
        // One offset for the whole file: a clock that is set meanwhile does not bend the times.
        offset_(base::wall_now().time_since_epoch() - base::steady_now().time_since_epoch()),
        rings_{Ring<Entry>(capacity), Ring<Entry>(capacity)},
        thread_([this] { run(); }) {}

  /// Writes what is still waiting.
  ~RecordWriter() {
    {
      std::lock_guard lock(mutex_);
      stop_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;

  /// Never waits. Received entries come from one thread. Sent ones mostly too, but a rare command
  /// of another thread may meet them: the later of the two is then dropped, counted.
  void put(Entry entry) noexcept {
    if (!entry.sent) {
      count_unless(rings_[0].put(std::move(entry)));
      return;
    }
    std::unique_lock one_at_a_time(sent_mutex_, std::try_to_lock);
    count_unless(one_at_a_time.owns_lock() && rings_[1].put(std::move(entry)));
  }

  /// Any thread.
  RecordStatus status() const {
    std::lock_guard lock(mutex_);
    RecordStatus out = status_;
    out.dropped += dropped_.load(std::memory_order_relaxed);
    return out;
  }

 private:
  void count_unless(bool taken) noexcept {
    if (!taken) dropped_.fetch_add(1, std::memory_order_relaxed);
  }

  void run() {
    base::Time synced = base::steady_now();
    std::unique_lock lock(mutex_);
    for (bool last = false; !last;) {
      wake_.wait_for(lock, options_.write_every, [this] { return stop_; });
      last = stop_;
      lock.unlock();
      write_waiting();
      if (last || base::steady_now() - synced >= options_.sync_every) {
        if (!stopped_) check(file_->sync());
        synced = base::steady_now();
      }
      lock.lock();
    }
  }

  void write_waiting() {
    batch_.clear();
    for (auto& ring : rings_) ring.take(batch_);
    if (batch_.empty()) return;
    std::stable_sort(batch_.begin(), batch_.end(),
                     [](const Entry& a, const Entry& b) { return a.stamp < b.stamp; });
    text_.clear();
    RecordStatus done;
    for (const Entry& entry : batch_) {
      format_(text_, entry, entry.stamp.time_since_epoch() + offset_);
      ++(entry.sent ? done.sent : done.received);
    }
    write(text_, done);
  }

  void write(const std::string& text, const RecordStatus& counts) {
    const bool ok = !stopped_ && check(file_->write(text));
    std::lock_guard lock(mutex_);
    if (!ok) {
      status_.dropped += counts.received + counts.sent;
      return;
    }
    status_.received += counts.received;
    status_.sent += counts.sent;
    status_.bytes = file_->written();
  }

  bool check(const base::Result<void>& result) {
    if (result) return true;
    stopped_ = true;
    {
      std::lock_guard lock(mutex_);
      status_.problem = result.error().detail;
    }
    if (options_.on_problem) options_.on_problem(result.error().detail);
    return false;
  }

  const std::unique_ptr<RecordFile> file_;
  const Format format_;
  const RecordOptions options_;
  const base::Duration offset_;
  std::array<Ring<Entry>, 2> rings_;  // received, sent
  std::mutex sent_mutex_;             // leaf; only ever tried
  std::atomic<std::uint64_t> dropped_{0};
  bool stopped_ = false;  // writer thread, like the next two
  std::vector<Entry> batch_;
  std::string text_;
  mutable std::mutex mutex_;  // leaf; guards stop_ and status_
  std::condition_variable wake_;
  bool stop_ = false;
  RecordStatus status_;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace roverd::link
