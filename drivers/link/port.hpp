#pragma once
// What every driver on a link has in common: the machine of lifecycle.hpp, opening and opening
// again, counting and reporting. The driver owns one and gives it the meaning of what comes in.
// Device thread only. Time is an argument.

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/measurements.hpp"
#include "base/result.hpp"
#include "link/lifecycle.hpp"
#include "link/link.hpp"

namespace roverd::link {

/// What comes in over a link, and how one listens.
inline void listen(ByteLink& link, std::function<void(Bytes, Time)> on) {
  link.on_bytes = std::move(on);
}
inline void listen(FrameLink& link, std::function<void(const CanFrame&, Time)> on) {
  link.on_frame = std::move(on);
}
inline SendResult put(ByteLink& link, Bytes bytes) noexcept {
  return link.write(bytes);
}
inline SendResult put(FrameLink& link, const CanFrame& frame) noexcept {
  return link.send(frame);
}
inline std::uint64_t strangers_of(const ByteLink& link) noexcept {
  return link.strangers();
}
inline std::uint64_t strangers_of(const FrameLink&) noexcept {
  return 0;
}
inline std::map<std::string, std::uint64_t> troubles_of(const ByteLink& link) {
  return link.troubles();
}
inline std::map<std::string, std::uint64_t> troubles_of(const FrameLink&) {
  return {};
}

/// @tparam Link ByteLink or FrameLink. @tparam Item what it carries: Bytes or const CanFrame&.
template <class Link, class Item>
class Port {
 public:
  using Phase = base::DriverPhase;
  using MakeLink = std::function<base::Result<std::unique_ptr<Link>>()>;
  using OnItem = std::function<void(Item, Time)>;
  using OnMeasurement = std::function<void(const base::Measurement&)>;

  struct Names {
    std::string name;         ///< of the driver
    std::string waiting_for;  ///< "waiting for feedback"
    double retry_first_s = 0.5;
    double retry_max_s = 5.0;
  };

  /// @param forget called whenever what was heard before is worth nothing any more.
  Port(Names names, MakeLink make_link, OnItem on_item, std::function<void()> forget,
       OnMeasurement on_measurement)
      : names_(std::move(names)),
        make_link_(std::move(make_link)),
        on_item_(std::move(on_item)),
        forget_(std::move(forget)),
        on_measurement_(std::move(on_measurement)),
        life_(names_.retry_first_s, names_.retry_max_s) {}
  ~Port() { close(); }
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  /// Further hooks, before start. Opening: just before the link is opened, each time. Reporting:
  /// the status is about to be told. Completing: what the driver counts apart, at each status.
  void on_opening(std::function<void(Link&, Time)> hook) { opening_ = std::move(hook); }
  void on_reporting(std::function<void(Time)> hook) { reporting_ = std::move(hook); }
  void on_completing(std::function<void(base::DriverStatus&)> hook) {
    completing_ = std::move(hook);
  }

  bool is_open() const noexcept { return open_; }
  bool is_up() const noexcept { return life_.phase() == Phase::Up; }
  Phase phase() const noexcept { return life_.phase(); }
  /// When the device was last heard, or the link opened.
  Time last_heard() const noexcept { return last_heard_; }
  /// Why nothing was heard: the cable, or what is at its other end. @param missing "no feedback".
  std::string silence(const std::string& missing) const {
    if (!last_item_ || *last_item_ <= last_heard_) return missing + ": the port is silent";
    return missing + ", only other bytes: another device on this port, or a wrong baud rate";
  }
  const std::string& name() const noexcept { return names_.name; }

  void start(Time now) {
    now_ = now;
    if (life_.phase() == Phase::Down) open(now);
    report(now);
  }
  /// Opens again when it is time, and reports.
  void tick(Time now) {
    now_ = now;
    if (!open_ && life_.retry_due(now)) open(now);
    report(now);
  }
  void stop(Time now) {
    now_ = now;
    if (life_.phase() == Phase::Down) return;
    close();
    forget_();
    life_.down();
    report(now);
  }

  /// It speaks, which is not enough to be up.
  void alive(Time stamp) noexcept { last_heard_ = stamp; }
  /// The device is there.
  void heard(Time stamp) {
    last_heard_ = stamp;
    if (life_.phase() == Phase::Up || !open_) return;
    life_.up();
    report(stamp);
  }
  /// It is not there: only its own voice brings it back. The link stays open.
  void lose(const std::string& reason, Time now) {
    if (life_.phase() == Phase::Faulty && life_.reason() == reason) return;
    forget_();
    life_.faulty(reason, now);
  }
  /// As lose, and the link is closed, to be opened again after the back-off.
  void fail(const std::string& reason, Time now) {
    close();
    forget_();
    life_.faulty(reason, now);
  }

  SendResult write(Item item) noexcept {
    if (!open_) return SendResult::Closed;
    const SendResult result = put(*link_, item);
    if (result == SendResult::Sent) ++sent_;
    return result;
  }

  /// Of a recording: what was sent then. @param on_sent as ByteLink::on_sent; before start.
  void hear_sent(OnItem on_sent) { on_sent_ = std::move(on_sent); }

  /// ByteLink::retune of an open link.
  bool retune() { return open_ && link_->retune(); }
  /// FrameLink::report, once there is a link.
  BusReport bus(Time now) { return link_ ? link_->report(now) : BusReport{}; }
  const std::string& reason() const noexcept { return life_.reason(); }
  /// Tells the status now: something in it is news.
  void say(Time now) {
    static_cast<void>(life_.report_due(now));  // a change is told with it
    tell(now);
  }

  void received(Time stamp) {
    ++received_;
    last_received_ = stamp;
  }
  /// @param cause in words: "wrong length".
  void refused(const std::string& cause) { count(cause, 1); }
  void count(const std::string& cause, std::uint64_t more) {
    refused_ += more;
    counts_[cause] += more;
    refused_last_ = cause;
    refused_last_at_ = last_item_ ? std::max(*last_item_, now_) : now_;
  }
  /// Bytes that belong to nothing: counted one by one, and once as a refusal.
  void stray(const std::string& cause, std::uint64_t bytes) {
    if (bytes == 0) return;
    refused(cause);
    note(cause, bytes - 1);
  }
  /// As note, of pieces that the device counted and that never came; that came again.
  void lost(const std::string& what, std::uint64_t more) {
    lost_ += more;
    note(what, more);
  }
  void twice(const std::string& what) {
    ++twice_;
    note(what, 1);
  }
  /// As count, of what is no refusal: of no use, lost on the way.
  void note(const std::string& what, std::uint64_t more) { counts_[what] += more; }
  void fact(const std::string& key, std::string value) { facts_[key] = std::move(value); }
  void hazards(std::vector<std::string> all) { hazards_ = std::move(all); }

  base::DriverStatus status(Time now) const {
    base::DriverStatus s;
    s.stamp = now;
    s.name = names_.name;
    s.phase = life_.phase();
    s.reason = life_.reason();
    s.received = received_;
    s.refused = refused_;
    s.sent = sent_;
    s.last_received = last_received_;
    auto detail = std::make_shared<base::DriverDetail>();
    detail->counts = counts_;
    detail->lost = lost_;
    detail->twice = twice_;
    detail->refused_last = refused_last_;
    detail->refused_last_at = refused_last_at_;
    if (link_) {
      s.link = link_->describe();
      s.link_open = open_;
      const std::uint64_t strangers = strangers_of(*link_);
      if (strangers > 0) detail->counts["from a foreign address"] = strangers;
      detail->foreign = strangers;
      for (const auto& [what, n] : troubles_of(*link_)) {
        detail->counts[what] += n;
        s.refused += n;
        if (n > 0 && detail->refused_last.empty()) detail->refused_last = what;
      }
    }
    detail->facts = facts_;
    detail->hazards = hazards_;
    s.detail = std::move(detail);
    if (completing_) completing_(s);
    return s;
  }

 private:
  void open(Time now) {
    if (!link_) {
      auto made = make_link_();
      if (!made) return life_.faulty(made.error().detail, now);
      link_ = std::move(*made);
      listen(*link_, [this](Item item, Time t) {
        if (!open_) return;
        last_item_ = t;
        on_item_(item, t);
      });
      link_->on_closed = [this](const std::string& reason) { fail(reason, now_); };
      if constexpr (requires { link_->on_sent; }) {
        if (on_sent_) {
          link_->on_sent = [this](Item item, Time t) {
            if (open_) on_sent_(item, t);
          };
        }
      }
    }
    if (opening_) opening_(*link_, now);
    life_.opening(names_.waiting_for);
    last_heard_ = now;
    open_ = true;  // before open: a link may hand over the first bytes from inside it
    if (const auto opened = link_->open(); !opened) fail(opened.error().detail, now);
  }
  void close() noexcept {
    open_ = false;
    if (link_) link_->close();
  }
  void report(Time now) {
    if (life_.report_due(now)) tell(now);
  }
  void tell(Time now) {
    if (reporting_) reporting_(now);
    on_measurement_(status(now));
  }

  const Names names_;
  const MakeLink make_link_;
  const OnItem on_item_;
  OnItem on_sent_;
  const std::function<void()> forget_;
  const OnMeasurement on_measurement_;
  std::function<void(Link&, Time)> opening_;
  std::function<void(Time)> reporting_;
  std::function<void(base::DriverStatus&)> completing_;
  std::unique_ptr<Link> link_;
  Lifecycle life_;
  bool open_ = false;
  Time now_{};  ///< of the last call, for callbacks that carry no time
  Time last_heard_{};
  std::optional<Time> last_item_;
  std::optional<Time> last_received_;
  std::uint64_t received_ = 0;
  std::uint64_t refused_ = 0;
  std::uint64_t sent_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t twice_ = 0;
  std::string refused_last_;
  std::optional<Time> refused_last_at_;
  std::map<std::string, std::uint64_t> counts_;
  std::map<std::string, std::string> facts_;
  std::vector<std::string> hazards_;
};

using BytePort = Port<ByteLink, Bytes>;
using FramePort = Port<FrameLink, const CanFrame&>;

}  // namespace roverd::link
