#include "net/doorbell.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include <sys/eventfd.h>
#include <unistd.h>

namespace roverd::net {

namespace {

int make_eventfd() {
  const int fd = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (fd < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  return fd;
}

}  // namespace

Doorbell::Doorbell(boost::asio::io_context& io, std::function<void()> answer)
    : fd_(io, make_eventfd()), answer_(std::move(answer)) {
  listen();
}

Doorbell::~Doorbell() = default;

void Doorbell::listen() {
  fd_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                 [this](boost::system::error_code ec) {
                   listening_ = false;
                   if (ec) return;
                   std::uint64_t rings = 0;
                   while (::read(fd_.native_handle(), &rings, sizeof rings) > 0) continue;
                   answer_();
                   if (fd_.is_open()) listen();
                 });
  listening_ = true;
}

void Doorbell::resume() {
  if (listening_) return;
  ring();  // what was cut off is answered now
  listen();
}

void Doorbell::ring() noexcept {
  const std::uint64_t one = 1;
  // Fails only when the counter is full: then the bell is ringing anyway.
  [[maybe_unused]] const auto n = ::write(fd_.native_handle(), &one, sizeof one);
}

void Doorbell::silence() {
  boost::system::error_code ignored;
  fd_.cancel(ignored);
}

}  // namespace roverd::net
