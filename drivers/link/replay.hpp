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

/// A recording in place of the link that it was made from. @tparam Link FrameLink or ByteLink.
/// @tparam File what reads the recording and hands it to the link's callbacks.
template <class Link, class File>
class Replay : public Link {
 public:
  ~Replay() override { close(); }

  base::Result<void> open() override {
    if (ended_) {
      return base::fail(base::Code::Conflict, "the replay of " + path_ + " has ended");
    }
    close();
    if (auto opened = file_.open(); !opened) return opened;
    open_ = true;
    pump_.start([this](const std::string& reason) {
      ended_ = true;
      open_ = false;
      if (this->on_closed) this->on_closed(reason);
    });
    return {};
  }
  void close() noexcept override {
    open_ = false;
    pump_.stop();
  }
  std::string describe() const override { return "replay:" + path_; }

 protected:
  /// @param make_file returns the File of that path.
  template <class MakeFile>
  Replay(asio::io_context& io, const std::string& path, const ReplayOptions& options,
         MakeFile&& make_file)
      : path_(path), file_(make_file(path)), pump_(io, file_, options) {}
  SendResult swallow() const noexcept { return open_ ? SendResult::Sent : SendResult::Closed; }

 private:
  const std::string path_;
  File file_;
  ReplayPump pump_;
  std::atomic<bool> open_{false};
  bool ended_ = false;
};

class FrameReplay final : public Replay<FrameLink, FrameFile> {
 public:
  FrameReplay(asio::io_context& io, const std::string& path, const ReplayOptions& options = {});
  SendResult send(const CanFrame&) noexcept override { return swallow(); }
};

class ByteReplay final : public Replay<ByteLink, ByteFile> {
 public:
  ByteReplay(asio::io_context& io, const std::string& path, const ReplayOptions& options = {});
  SendResult write(Bytes) noexcept override { return swallow(); }
};

}  // namespace roverd::link
