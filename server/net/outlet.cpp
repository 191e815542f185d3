#include "net/outlet.hpp"

#include <array>

#include <boost/asio/error.hpp>

namespace roverd::net {

Outlet::error_code Outlet::read_ahead() {
  static thread_local std::array<char, kAheadBytes> bytes;
  error_code ec;
  std::size_t n = 0;
  while (!ec && n < bytes.size()) {  // one read may give less than there is
    n += wire_.read_some(bytes.data() + n, bytes.size() - n, ec);
  }
  ahead_.assign(bytes.data(), n);
  taken_ = 0;
  look(ahead_);
  return n > 0 ? error_code{} : ec;  // an end comes again with the next read
}

bool Outlet::write(const std::string& bytes) {
  while (offset_ < bytes.size()) {
    error_code ec;
    offset_ += wire_.write_some(bytes.data() + offset_, bytes.size() - offset_, ec);
    if (!ec) continue;
    if (ec != boost::asio::error::would_block) {  // broken: the read side hears of it, too
      finished_ = true;
      current_.reset();
      own_.clear();
      offset_ = 0;
      error_code ignored;
      wire_.socket().shutdown(Wire::Socket::shutdown_both, ignored);
      return true;
    }
    if (!blocked_) {
      blocked_ = true;
      if (on_blocked) on_blocked();
    }
    return false;
  }
  offset_ = 0;
  return true;
}

bool Outlet::flush() {
  blocked_ = false;
  if (current_) {
    const Frame frame = current_;
    if (!write(*frame)) return false;
    current_.reset();
  }
  if (!own_.empty()) {
    if (!write(own_)) return false;
    own_.clear();
  }
  return true;
}

}  // namespace roverd::net
