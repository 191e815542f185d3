#pragma once
// Wakes the web thread from any other thread without waiting and without allocating (an eventfd):
// what the control loop may use.

#include <atomic>
#include <cstdint>
#include <functional>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>

namespace roverd::net {

class Doorbell {
 public:
  /// @param answer runs on the io_context's thread, once for one or more rings. Throws at start-up
  /// if the system has no eventfd left.
  Doorbell(boost::asio::io_context& io, std::function<void()> answer);
  ~Doorbell();
  Doorbell(const Doorbell&) = delete;
  Doorbell& operator=(const Doorbell&) = delete;

  /// Any thread, while this object lives.
  void ring() noexcept;
  /// io_context's thread. An exception has left its run(): listens on if it had cut that off.
  void resume();
  /// io_context's thread: no answers any more, so that the io_context can run out of work.
  void silence();

 private:
  void listen();

  boost::asio::posix::stream_descriptor fd_;
  std::function<void()> answer_;
  bool listening_ = false;
};

}  // namespace roverd::net
