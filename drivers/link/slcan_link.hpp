#pragma once
// A serial-line CAN adapter spoken to directly (slcan.hpp), without slcand and without CAN in the
// kernel.
//
//   Closed ─open─▶ Clearing ─0.2 s─▶ Speed ─CR─▶ Opening ─CR─▶ Open
//     ▲              │                 └─ BEL, 1 s of silence ─┤   │
//     └── close ─────┴─────────────── lost: on_closed ─────────┴───┘
//
// Clearing sends C and Z0 (channel closed, no time stamps) and throws away whatever the line still
// holds; Speed sends S6 or another rate; Opening sends O. Once a second the adapter is asked for
// its status (F); three questions without an answer, and it is left alone. close() sends C.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <boost/asio/steady_timer.hpp>

#include "link/confirmations.hpp"
#include "link/link.hpp"
#include "link/serial.hpp"
#include "link/slcan.hpp"

namespace roverd::link {

class SlcanLink final : public FrameLink {
 public:
  enum class Phase { Closed, Clearing, Speed, Opening, Open };

  /// @param bitrate one that slcan_speed knows; absent: 500 000 bit/s.
  SlcanLink(asio::io_context& io, std::string device, unsigned baud,
            std::optional<unsigned> bitrate = {});
  ~SlcanLink() override;

  /// The serial port's errors. What the adapter refuses comes through on_closed.
  base::Result<void> open() override;
  void close() noexcept override;
  /// Closed until the adapter's channel is open. Busy: the port has no room, or the frame is not
  /// valid.
  SendResult send(const CanFrame& frame) noexcept override;
  std::string describe() const override;
  BusReport report(Time now) override;

  Phase phase() const noexcept { return phase_.load(std::memory_order_acquire); }

 private:
  void enter(Phase phase, const std::string& command, base::Duration patience);
  void time_is_up();
  void ask_for_status();
  void hear(Bytes bytes, Time stamp);
  void hear_line(const SlcanFramer::Piece& piece, Time stamp);
  void take(const SlcanLine& line, Time stamp);
  /// An answer to a command: to the start sequence, or to a frame.
  void answered(bool good);
  void fail(const std::string& reason);

  const unsigned bitrate_;
  const bool bitrate_given_;
  const std::string device_;
  const unsigned baud_;
  SerialLink serial_;
  asio::steady_timer timer_;
  std::atomic<Phase> phase_{Phase::Closed};
  Confirmations confirmations_;
  std::atomic<bool> half_a_line_{false};  ///< the port took a part: end it before the next

  // Device thread.
  std::shared_ptr<const int> session_;  ///< handlers hold it weakly: gone means closed meanwhile
  SlcanFramer framer_;
  std::vector<SlcanFramer::Piece> pieces_;
  std::string command_;  ///< of the start sequence, without CR
  int unanswered_ = 0;   ///< questions for the status
  std::uint64_t refused_lines_ = 0;
  std::uint64_t refused_commands_ = 0;
  std::uint64_t bus_errors_ = 0;
  std::string last_refusal_;
  std::optional<SlcanLine> state_;
  std::uint8_t flags_ = 0;
};

}  // namespace roverd::link
