#pragma once
// CAN without a CAN kernel: a UNIX SOCK_SEQPACKET socket on which every packet is exactly one
// struct can_frame (can_wire.hpp). One program listens and is the bus; every other connects.
//
//   client ──▶ ┐            ┌─▶ on_frame of the server's program
//   client ◀── ┴─ server ───┴─▶ every other client        (never back to the sender)
//
// Like a bus, it has no memory: a frame a client has no room for is lost for that client alone,
// counted. The kernel's socket buffer is the bound (about 270 frames).

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <sys/types.h>

#include "link/descriptor.hpp"
#include "link/link.hpp"

namespace roverd::link {

/// A client. open() fails at once if nobody listens at the path.
class CanSocketLink final : public FrameLink {
 public:
  CanSocketLink(asio::io_context& io, std::string path);
  ~CanSocketLink() override;

  base::Result<void> open() override;
  void close() noexcept override;
  /// An invalid frame (can_wire.hpp) is not sent: Busy, counted in refused().
  SendResult send(const CanFrame& frame) noexcept override;
  std::string describe() const override { return "cansock:" + path_; }

  /// Packets that are not a CAN frame, in either direction. Any thread.
  std::uint64_t refused() const noexcept { return refused_.load(std::memory_order_relaxed); }

 private:
  void read();
  void lost(const std::string& reason);

  const std::string path_;
  Descriptor socket_;
  std::atomic<std::uint64_t> refused_{0};
};

/// The listening end, for the simulator: a hub for any number of clients up to kMaxClients.
/// As a FrameLink its send() reaches all clients and on_frame hears all of them; on_closed is never
/// called, for a bus stays when clients come and go.
class CanSocketServer final : public FrameLink {
 public:
  static constexpr std::size_t kMaxClients = 32;

  CanSocketServer(asio::io_context& io, std::string path);
  ~CanSocketServer() override;

  /// Listens. A socket file that nobody answers at is removed first; one that is in use, and any
  /// other kind of file, is left alone and is an error.
  base::Result<void> open() override;
  /// Drops the clients and removes the socket file, if it is still ours.
  void close() noexcept override;
  /// Any thread. Sent also when there is no client. Busy: at least one client had no room. May wait
  /// for the few microseconds in which another thread spreads a frame.
  SendResult send(const CanFrame& frame) noexcept override;
  std::string describe() const override { return "cansock:" + path_; }

  /// Any thread.
  std::size_t clients() const;
  std::uint64_t refused() const noexcept { return refused_.load(std::memory_order_relaxed); }
  /// Frames a slow client missed, over all clients. Any thread.
  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  struct Client {
    explicit Client(asio::io_context& io) : socket(io) {}
    Descriptor socket;
  };

  base::Result<int> bind_listener();
  void accept();
  void read(Client& client);
  void drop(const Client& client);
  SendResult spread(const CanFrame& frame, const Client* from) noexcept;

  asio::io_context& io_;
  const std::string path_;
  Descriptor listener_;
  ino_t inode_ = 0;  ///< of the socket file we made
  dev_t device_ = 0;
  mutable std::mutex mutex_;  // leaf; guards the list clients_, changed on the device thread only
  std::vector<std::shared_ptr<Client>> clients_;  // shared with a read in progress
  std::atomic<std::uint64_t> refused_{0};
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace roverd::link
