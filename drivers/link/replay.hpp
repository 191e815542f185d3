#pragma once
// Recordings as links: what was heard then is heard again, at the recorded pace or another.
//
// open() refuses a file that is missing, unreadable or of the wrong kind, with the line that is
// wrong. At the end of the file, or at a damaged line further on, on_closed says so; a link that
// has ended stays so (open() is then a Conflict), for a driver that reconnects would play it over
// and over. What is sent goes nowhere and counts as Sent. Items are stamped when they are handed
// over, like those of any other link.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "link/link.hpp"
#include "link/replay_file.hpp"
#include "link/replay_options.hpp"

namespace roverd::link {

namespace asio = boost::asio;

/// Plays one file by the clock, on the io_context's thread.
class ReplayPump {
 public:
  /// Silence between the end and the new beginning, in recorded time.
  static constexpr base::Duration kLoopGap = std::chrono::seconds(1);

  ReplayPump(asio::io_context& io, ReplayFile& file, const ReplayOptions& options);

  /// @param on_end called once with the reason, unless stopped before.
  void start(std::function<void(const std::string&)> on_end);
  void stop() noexcept;
  std::uint64_t played() const noexcept { return played_; }

 private:
  void step();
  void again(base::Duration after);
  /// @return false when there is nothing more to play; on_end has then been called.
  bool load();
  void end(const std::string& reason);
  base::Duration due_in(Time now) const;
  base::Duration position(Time now) const;
  base::Duration lead() const noexcept;

  asio::steady_timer timer_;
  ReplayFile& file_;
  const double speed_;
  const bool loop_;
  const std::shared_ptr<ReplayTogether> together_;
  /// Only while playing; handlers hold it weakly and do nothing once it is gone.
  std::shared_ptr<const std::function<void(const std::string&)>> on_end_;
  Time started_;
  base::Duration lap_{};   ///< recorded time of the rounds before
  base::Duration at_{};    ///< of the loaded item, rounds before included
  base::Duration skip_{};  ///< what is due before is left out
  bool loaded_ = false;
  std::uint64_t played_ = 0;
  std::uint64_t played_this_lap_ = 0;
};

class FrameReplay final : public FrameLink {
 public:
  FrameReplay(asio::io_context& io, std::string path, const ReplayOptions& options = {});
  ~FrameReplay() override;

  base::Result<void> open() override;
  void close() noexcept override;
  SendResult send(const CanFrame& frame) noexcept override;
  std::string describe() const override { return "replay:" + path_; }

 private:
  const std::string path_;
  FrameFile file_;
  ReplayPump pump_;
  std::atomic<bool> open_{false};
  bool ended_ = false;
};

class ByteReplay final : public ByteLink {
 public:
  ByteReplay(asio::io_context& io, std::string path, const ReplayOptions& options = {});
  ~ByteReplay() override;

  base::Result<void> open() override;
  void close() noexcept override;
  SendResult write(Bytes bytes) noexcept override;
  std::string describe() const override { return "replay:" + path_; }

 private:
  const std::string path_;
  ByteFile file_;
  ReplayPump pump_;
  std::atomic<bool> open_{false};
  bool ended_ = false;
};

}  // namespace roverd::link
