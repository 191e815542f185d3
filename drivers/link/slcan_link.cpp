#include "link/slcan_link.hpp"

#include <utility>

#include "link/can_wire.hpp"

namespace roverd::link {
namespace {

using namespace std::chrono_literals;

constexpr base::Duration kClearing = 200ms;
constexpr base::Duration kAnswer = 1s;
constexpr base::Duration kStatusPeriod = 1s;
constexpr int kUnansweredMost = 3;

}  // namespace

SlcanLink::SlcanLink(asio::io_context& io, std::string device, unsigned baud,
                     std::optional<unsigned> bitrate)
    : bitrate_(bitrate.value_or(kSlcanDefaultBitrate)),
      bitrate_given_(bitrate.has_value()),
      device_(device),
      baud_(baud),
      serial_(io, std::move(device), baud),
      timer_(io) {
  serial_.on_bytes = [this](Bytes bytes, Time stamp) { hear(bytes, stamp); };
  serial_.on_closed = [this](const std::string& reason) { fail(reason); };
}

SlcanLink::~SlcanLink() {
  close();
}

std::string SlcanLink::describe() const {
  return "slcan:" + device_ + ":" + std::to_string(baud_) +
         (bitrate_given_ ? ":" + std::to_string(bitrate_) : "");
}

base::Result<void> SlcanLink::open() {
  close();
  const auto digit = slcan_speed(bitrate_);
  if (!digit) {
    return base::fail(base::Code::Invalid,
                      "no serial-line CAN adapter has " + std::to_string(bitrate_) + " bit/s");
  }
  if (auto opened = serial_.open(); !opened) return opened;
  framer_.reset();
  state_.reset();
  flags_ = 0;
  unanswered_ = 0;
  session_ = std::make_shared<const int>(0);
  enter(Phase::Clearing, "C\rZ0", kClearing);
  return {};
}

void SlcanLink::close() noexcept {
  if (phase() != Phase::Closed) {
    static constexpr std::array<std::uint8_t, 2> kGoodbye{'C', '\r'};
    serial_.write(kGoodbye);
  }
  phase_.store(Phase::Closed, std::memory_order_release);
  session_.reset();
  timer_.cancel();
  serial_.close();
  confirmations_.forget();
}

void SlcanLink::enter(Phase phase, const std::string& command, base::Duration patience) {
  phase_.store(phase, std::memory_order_release);
  command_ = command;
  const std::string line = command + '\r';
  if (!command.empty()) {
    serial_.write(Bytes(reinterpret_cast<const std::uint8_t*>(line.data()), line.size()));
  }
  timer_.expires_after(patience);
  timer_.async_wait([this, weak = std::weak_ptr(session_)](const boost::system::error_code& ec) {
    if (!ec && weak.lock()) time_is_up();
  });
}

void SlcanLink::time_is_up() {
  switch (phase()) {
    case Phase::Closed:
      return;
    case Phase::Clearing:
      framer_.reset();
      return enter(Phase::Speed, std::string("S") + *slcan_speed(bitrate_), kAnswer);
    case Phase::Speed:
    case Phase::Opening:
      return fail("CAN adapter at " + device_ + " does not answer to " + command_);
    case Phase::Open:
      return ask_for_status();
  }
}

void SlcanLink::ask_for_status() {
  const bool worth_it = unanswered_ < kUnansweredMost;
  if (worth_it) ++unanswered_;
  enter(Phase::Open, worth_it ? "F" : "", kStatusPeriod);
}

SendResult SlcanLink::send(const CanFrame& frame) noexcept {
  if (phase() != Phase::Open) return SendResult::Closed;
  if (!is_valid(frame) || frame.error) return SendResult::Busy;
  std::string line = to_slcan_line(frame);
  if (half_a_line_.load(std::memory_order_relaxed)) line.insert(0, 1, '\r');
  confirmations_.sending(base::steady_now());
  const SendResult result =
      serial_.write(Bytes(reinterpret_cast<const std::uint8_t*>(line.data()), line.size()));
  if (result != SendResult::Sent) confirmations_.not_sent();
  half_a_line_.store(result == SendResult::Busy, std::memory_order_relaxed);
  return result;
}

void SlcanLink::hear(Bytes bytes, Time stamp) {
  if (phase() == Phase::Clearing) return;
  pieces_.clear();
  framer_.feed(bytes, pieces_);
  const std::weak_ptr session(session_);
  for (const auto& piece : pieces_) {
    if (session.expired()) return;  // closed by what the line before it meant
    hear_line(piece, stamp);
  }
}

void SlcanLink::hear_line(const SlcanFramer::Piece& piece, Time stamp) {
  if (piece.refused) return answered(false);
  const auto line = parse_slcan_line(piece.line);
  if (!piece.too_long && line) return take(*line, stamp);
  ++refused_lines_;
  last_refusal_ = piece.too_long ? "the line is too long" : line.error().detail;
}

void SlcanLink::take(const SlcanLine& line, Time stamp) {
  using Kind = SlcanLine::Kind;
  switch (line.kind) {
    case Kind::Done:
      return answered(true);
    case Kind::Refused:
      return answered(false);
    case Kind::Frame:
      if (phase() == Phase::Open && on_frame) on_frame(line.frame, stamp);
      return;
    case Kind::Flags:
      unanswered_ = 0;
      flags_ = line.flags;
      return;
    case Kind::State:
      state_ = line;
      return;
    case Kind::Errors:
      bus_errors_ += line.text.size();
      return;
    case Kind::Other:
      return;
  }
}

void SlcanLink::answered(bool good) {
  switch (phase()) {
    case Phase::Closed:
    case Phase::Clearing:
      return;
    case Phase::Speed:
    case Phase::Opening:
      if (!good) return fail("CAN adapter at " + device_ + " refuses " + command_);
      if (phase() == Phase::Speed) return enter(Phase::Opening, "O", kAnswer);
      return enter(Phase::Open, "", kStatusPeriod);
    case Phase::Open:
      if (good) return confirmations_.confirmed();
      ++refused_commands_;
      confirmations_.lose();
      return;
  }
}

void SlcanLink::fail(const std::string& reason) {
  const std::string why = reason;  // close() may take it away
  close();
  if (on_closed) on_closed(why);
}

BusReport SlcanLink::report(Time) {
  BusReport out;
  const bool is_open = phase() == Phase::Open;
  out.facts["can_interface"] = is_open ? "up" : "down";
  out.facts["can_kind"] = "slcan";
  out.facts["can_bitrate"] = std::to_string(bitrate_);
  if (state_) {
    out.facts["can_state"] = to_string(state_->controller);
    out.facts["can_tx_errors"] = std::to_string(state_->tx_errors);
    out.facts["can_rx_errors"] = std::to_string(state_->rx_errors);
  }
  if (flags_ != 0) out.facts["can_last_error"] = slcan_flag_words(flags_);
  if (!last_refusal_.empty()) out.facts["can_last_refused_line"] = last_refusal_;
  const auto count = [&out](const char* what, std::uint64_t n) {
    if (n > 0) out.counts.emplace(what, n);
  };
  count("adapter's line not understood", refused_lines_);
  count("adapter refused a command", refused_commands_);
  count("CAN error: bus error", bus_errors_);
  if (confirmations_.confirmed_count() > 0) {  // some adapters never answer to a frame
    out.facts["can_confirmed"] = std::to_string(confirmations_.confirmed_count()) + " of " +
                                 std::to_string(confirmations_.sent_count());
  }
  return out;
}

}  // namespace roverd::link
