#pragma once
// Sockets of the side channel: TCP on 127.0.0.1, one JSON object a line (sim/control.hpp).

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "base/result.hpp"
#include "sim/control.hpp"

namespace roverd::sim {

/// One thread, the io_context's. A client that does not read misses truths; one that does not read
/// its answers, or sends a line above kMaxControlLine, is dropped.
class ControlServer {
 public:
  static constexpr std::size_t kMaxClients = 16;
  static constexpr std::size_t kMaxWaiting = 256;  ///< answers of one client

  /// Both callables are asked on the io_context's thread.
  struct Plant {
    std::function<std::string()> truth;
    std::function<ControlAnswer(std::string_view line)> carry_out;
  };

  ControlServer(boost::asio::io_context& io, std::uint16_t port, Plant plant);
  ~ControlServer();
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;

  base::Result<void> open();
  void close() noexcept;
  std::uint16_t port() const noexcept { return port_; }  ///< after open()

 private:
  class Session;
  void accept();

  std::uint16_t port_;
  Plant plant_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  std::vector<std::weak_ptr<Session>> sessions_;
};

}  // namespace roverd::sim
