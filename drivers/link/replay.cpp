#include "link/replay.hpp"

#include <algorithm>
#include <utility>

#include "link/burst.hpp"

namespace roverd::link {
namespace {

/// A year: keeps a silly stamp or a tiny speed within the range of the clock.
constexpr double kLongestWait_s = 3.0e7;

}  // namespace

ReplayPump::ReplayPump(asio::io_context& io, ReplayFile& file, const ReplayOptions& options)
    : timer_(io),
      file_(file),
      speed_(options.speed),
      loop_(options.loop),
      together_(options.together) {}

void ReplayPump::start(std::function<void(const std::string&)> on_end) {
  on_end_ = std::make_shared<const std::function<void(const std::string&)>>(std::move(on_end));
  started_ = base::steady_now();
  lap_ = at_ = base::Duration::zero();
  loaded_ = false;
  played_this_lap_ = 0;
  skip_ = base::Duration::zero();
  if (together_) {
    Time::rep begun = 0;
    if (!together_->started.compare_exchange_strong(begun, started_.time_since_epoch().count())) {
      const Time now = started_;
      started_ = Time(base::Duration(begun));
      // Opened again: the others are elsewhere by now.
      if (now - started_ > std::chrono::seconds(1)) skip_ = position(now);
    }
  }
  again(base::Duration::zero());  // never from within the caller's open()
}

void ReplayPump::stop() noexcept {
  on_end_.reset();
  timer_.cancel();
}

void ReplayPump::again(base::Duration after) {
  timer_.expires_after(std::chrono::duration_cast<asio::steady_timer::duration>(after));
  timer_.async_wait([this, weak = std::weak_ptr(on_end_)](const boost::system::error_code& ec) {
    if (!ec && !weak.expired()) step();
  });
}

/// Where in recorded time the playing is.
base::Duration ReplayPump::position(Time now) const {
  return base::from_seconds(base::seconds(now - started_) * speed_);
}

/// How much later than the run this file begins.
base::Duration ReplayPump::lead() const noexcept {
  const auto begin = file_.begin();
  if (!together_ || !begin) return base::Duration::zero();
  return std::max(*begin - together_->begin, base::Duration::zero());
}

base::Duration ReplayPump::due_in(Time now) const {
  if (speed_ <= 0.0) return base::Duration::zero();
  const double wait_s = base::seconds(at_) / speed_ - base::seconds(now - started_);
  return base::from_seconds(std::min(wait_s, kLongestWait_s));
}

void ReplayPump::step() {
  for (int i = 0; i < kReadBurst; ++i) {
    if (!loaded_ && !load()) return;
    const base::Duration wait = due_in(base::steady_now());
    if (wait > base::Duration::zero()) {
      again(wait);
      return;
    }
    loaded_ = false;
    ++played_;
    ++played_this_lap_;
    const std::weak_ptr playing = on_end_;
    file_.emit(base::steady_now());
    if (playing.expired()) return;  // closed by the receiver
  }
  again(base::Duration::zero());
}

bool ReplayPump::load() {
  for (;;) {
    const auto due = file_.advance();
    if (!due) {
      end(due.error().detail);
      return false;
    }
    if (*due) {
      at_ = lap_ + lead() + **due;
      if (at_ < skip_) continue;
      loaded_ = true;
      return true;
    }
    if (!loop_ || played_this_lap_ == 0) {
      end("end of file");
      return false;
    }
    if (const auto rewound = file_.rewind(); !rewound) {
      end(rewound.error().detail);
      return false;
    }
    lap_ = at_ + kLoopGap;
    played_this_lap_ = 0;
  }
}

void ReplayPump::end(const std::string& reason) {
  const auto call = std::exchange(on_end_, nullptr);
  if (call) (*call)(reason);
}

FrameReplay::FrameReplay(asio::io_context& io, const std::string& path,
                         const ReplayOptions& options)
    : Replay(io, path, options, [this](const std::string& file) {
        return FrameFile(file, [this](const CanFrame& frame, Time t) {
          if (on_frame) on_frame(frame, t);
        });
      }) {}

ByteReplay::ByteReplay(asio::io_context& io, const std::string& path, const ReplayOptions& options)
    : Replay(io, path, options, [this, &options](const std::string& file) {
        return ByteFile(
            file, options,
            [this](Bytes bytes, Time t) {
              if (on_bytes) on_bytes(bytes, t);
            },
            [this](Bytes bytes, Time t) {
              if (on_sent) on_sent(bytes, t);
            });
      }) {}

}  // namespace roverd::link
