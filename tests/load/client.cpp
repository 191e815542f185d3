#include "load/client.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

namespace roverd::load {

namespace {

[[noreturn]] void fail(const char* what) {
  throw std::runtime_error(std::string(what) + ": " + std::strerror(errno));
}

}  // namespace

Connection::Connection(const Address& to) {
  sockaddr_in peer{};
  peer.sin_family = AF_INET;
  peer.sin_port = htons(to.port);
  if (inet_pton(AF_INET, to.host.c_str(), &peer.sin_addr) != 1) {
    throw std::runtime_error("not an IPv4 address: " + to.host);
  }
  handle_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (handle_ < 0) fail("socket");
  if (::connect(handle_, reinterpret_cast<const sockaddr*>(&peer), sizeof peer) != 0) {
    ::close(handle_);
    fail("connect");
  }
  const int on = 1;
  ::setsockopt(handle_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

Connection::~Connection() {
  ::close(handle_);
}

void Connection::upgrade(const Address& at, const std::string& path) {
  const std::string host = at.host + ":" + std::to_string(at.port);
  send("GET " + path + " HTTP/1.1\r\nHost: " + host +
       "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
       "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nOrigin: http://" +
       host + "\r\n\r\n");
  std::optional<int> status;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!(status = take_answer())) {
    if (!receive() || std::chrono::steady_clock::now() > end) {
      throw std::runtime_error("no answer to the upgrade");
    }
    ::usleep(200);
  }
  if (*status != 101) throw std::runtime_error("upgrade answered " + std::to_string(*status));
}

void Connection::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::send(handle_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (n < 0) fail("send");
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

bool Connection::receive() {
  buffer_.erase(0, begin_);
  begin_ = 0;
  std::array<char, 64 * 1024> chunk;
  const ssize_t n = ::recv(handle_, chunk.data(), chunk.size(), MSG_DONTWAIT);
  if (n > 0) buffer_.append(chunk.data(), static_cast<std::size_t>(n));
  return n > 0 || (n < 0 && errno == EAGAIN);
}

std::optional<int> Connection::take_answer() {
  const std::string_view all = pending();
  const auto head = all.find("\r\n\r\n");
  if (head == std::string_view::npos) return std::nullopt;
  if (!all.starts_with("HTTP/1.1 ") || head < 12) throw std::runtime_error("not an HTTP answer");
  int status = 0;
  std::from_chars(all.data() + 9, all.data() + 12, status);
  std::size_t length = 0;
  const std::string_view field = "\r\nContent-Length: ";
  if (const auto at = all.substr(0, head).find(field); at != std::string_view::npos) {
    std::from_chars(all.data() + at + field.size(), all.data() + head, length);
  }
  if (all.size() < head + 4 + length) return std::nullopt;
  begin_ += head + 4 + length;
  return status;
}

std::optional<Connection::Frame> Connection::take_frame() {
  const std::string_view all = pending();
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(all[i]); };
  if (all.size() < 2) return std::nullopt;
  std::uint64_t length = byte(1);  // a server never masks: the top bit is clear
  const std::size_t extra = length < 126 ? 0 : length == 126 ? 2 : 8;
  if (all.size() < 2 + extra) return std::nullopt;
  if (extra != 0) length = 0;
  for (std::size_t i = 0; i < extra; ++i) length = length << 8 | byte(2 + i);
  if (all.size() < 2 + extra + length) return std::nullopt;
  begin_ += 2 + extra + length;
  return Frame{byte(0) & 0x0F, all.substr(2 + extra, length)};
}

std::string masked_frame(int opcode, std::string_view text) {
  if (text.size() > 0xFFFF) throw std::runtime_error("this load sends short messages only");
  std::string frame;
  frame += static_cast<char>(0x80 | opcode);
  if (text.size() < 126) {
    frame += static_cast<char>(0x80 | text.size());
  } else {
    frame += static_cast<char>(0x80 | 126);
    frame += static_cast<char>(text.size() >> 8);
    frame += static_cast<char>(text.size() & 0xFF);
  }
  frame.append(4, '\0');
  frame += text;
  return frame;
}

}  // namespace roverd::load
