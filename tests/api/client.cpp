#include "client.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace roverd::test {

namespace {

using std::chrono::steady_clock;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

Answer read_head(std::string_view head) {
  Answer out;
  out.status = static_cast<unsigned>(std::stoul(std::string(head.substr(9, 3))));
  while (!head.empty()) {
    const auto end = std::min(head.find("\r\n"), head.size());
    const std::string_view line = head.substr(0, end);
    head.remove_prefix(std::min(end + 2, head.size()));
    const auto colon = line.find(": ");
    if (colon == std::string_view::npos) continue;
    std::string& value = out.headers[lower(std::string(line.substr(0, colon)))];
    value += (value.empty() ? "" : "\n") + std::string(line.substr(colon + 2));
  }
  return out;
}

}  // namespace

const char* tls_version() {
  return std::getenv("ROVERD_TEST_TLS");
}

/// A client that trusts anybody: whom it speaks to is judged elsewhere.
struct Secret {
  explicit Secret(int socket)
      : context(SSL_CTX_new(TLS_client_method())), connection(SSL_new(context)) {
    const int version = std::string(tls_version()) == "1.2" ? TLS1_2_VERSION : TLS1_3_VERSION;
    SSL_set_min_proto_version(connection, version);
    SSL_set_max_proto_version(connection, version);
    SSL_clear_mode(connection, SSL_MODE_AUTO_RETRY);
    SSL_set_fd(connection, socket);
  }
  ~Secret() {
    SSL_free(connection);
    SSL_CTX_free(context);
  }
  Secret(const Secret&) = delete;
  Secret& operator=(const Secret&) = delete;

  bool send(std::string_view bytes) {
    shaken = shaken || SSL_connect(connection) == 1;
    return shaken && SSL_write(connection, bytes.data(), static_cast<int>(bytes.size())) > 0;
  }
  bool waits() const { return shaken && SSL_pending(connection) > 0; }
  /// As recv; -2: only TLS's own words came.
  int receive(char* into, std::size_t size) {
    const int n = SSL_read(connection, into, static_cast<int>(size));
    return n <= 0 && SSL_get_error(connection, n) == SSL_ERROR_WANT_READ ? -2 : n;
  }

  SSL_CTX* context;
  SSL* connection;
  bool shaken = false;
};

namespace {

int connected(const std::string& address, std::uint16_t port, const std::string& source) {
  sockaddr_in v4{};
  v4.sin_family = AF_INET;
  v4.sin_port = htons(port);
  sockaddr_in6 v6{};
  v6.sin6_family = AF_INET6;
  v6.sin6_port = htons(port);
  const bool old = ::inet_pton(AF_INET, address.c_str(), &v4.sin_addr) == 1;
  ::inet_pton(AF_INET6, address.c_str(), &v6.sin6_addr);
  const int handle = ::socket(old ? AF_INET : AF_INET6, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (!source.empty()) {
    sockaddr_in from{};
    from.sin_family = AF_INET;
    ::inet_pton(AF_INET, source.c_str(), &from.sin_addr);
    if (::bind(handle, reinterpret_cast<const sockaddr*>(&from), sizeof from) != 0) {
      throw std::runtime_error("no such source: " + source);
    }
  }
  const int refused = old ? ::connect(handle, reinterpret_cast<const sockaddr*>(&v4), sizeof v4)
                          : ::connect(handle, reinterpret_cast<const sockaddr*>(&v6), sizeof v6);
  if (refused == 0) return handle;
  ::close(handle);
  throw std::runtime_error("nobody listens");
}

}  // namespace

Client::Client(std::uint16_t port, const std::string& address, const std::string& source)
    : handle_(connected(address, port, source)) {
  if (tls_version() == nullptr) return;
  std::signal(SIGPIPE, SIG_IGN);  // OpenSSL does not ask send() to be silent
  secret_ = std::make_unique<Secret>(handle_);
}

Client::~Client() {
  ::close(handle_);
}

bool Client::send(std::string_view bytes) {
  if (secret_) return bytes.empty() || secret_->send(bytes);
  while (!bytes.empty()) {
    const auto n = ::send(handle_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

bool Client::receive(steady_clock::time_point until) {
  if (closed_) return false;
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(until - steady_clock::now());
  pollfd wait{handle_, POLLIN, 0};
  const bool here = secret_ && secret_->waits();
  if (!here && (left.count() < 0 || ::poll(&wait, 1, static_cast<int>(left.count())) <= 0)) {
    return false;
  }
  std::array<char, 16 * 1024> bytes;
  const bool secret = secret_ && secret_->shaken;
  const auto n = secret ? secret_->receive(bytes.data(), bytes.size())
                        : ::recv(handle_, bytes.data(), bytes.size(), 0);
  if (n == -2) return true;
  if (n <= 0) closed_ = true;
  if (n > 0) in_.append(bytes.data(), static_cast<std::size_t>(n));
  return n > 0;
}

std::optional<Answer> Client::answer(bool no_body) {
  const auto until = steady_clock::now() + kPatience;
  std::size_t end = 0;
  while ((end = in_.find("\r\n\r\n")) == std::string::npos) {
    if (!receive(until)) return std::nullopt;
  }
  Answer out = read_head(std::string_view(in_).substr(0, end));
  in_.erase(0, end + 4);
  const bool empty = no_body || out.status == 304 || out.status == 204 || out.status < 200;
  const std::string length = out.header("content-length");
  const std::size_t n = empty || length.empty() ? 0 : std::stoul(length);
  while (in_.size() < n) {
    if (!receive(until)) return std::nullopt;
  }
  out.body = in_.substr(0, n);
  in_.erase(0, n);
  return out;
}

bool Client::closed_within(std::chrono::milliseconds time) {
  const auto until = steady_clock::now() + time;
  while (receive(until)) continue;
  return closed_;
}

unsigned Client::upgrade(const std::string& path, const std::string& more_headers) {
  // The key is the example of RFC 6455, section 1.3; its answer is checked below.
  send("GET " + path +
       " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
       "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
       more_headers + "\r\n");
  const auto reply = answer();
  if (!reply) return 0;
  const bool right = reply->header("sec-websocket-accept") == "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=";
  return reply->status == 101 && !right ? 0 : reply->status;
}

std::optional<Client::Frame> Client::frame(std::chrono::milliseconds time) {
  const auto until = steady_clock::now() + time;
  const auto byte = [this](std::size_t i) { return static_cast<unsigned char>(in_.at(i)); };
  while (true) {
    if (in_.size() >= 2) {
      const unsigned code = byte(1) & 0x7f;
      const std::size_t extra = code == 126 ? 2 : code == 127 ? 8 : 0;
      std::size_t length = extra == 0 ? code : 0;
      if (in_.size() >= 2 + extra) {
        for (std::size_t i = 0; i < extra; ++i) length = length * 256 + byte(2 + i);
        if (in_.size() >= 2 + extra + length) {
          Frame out{byte(0) & 0x0f, in_.substr(2 + extra, length)};
          in_.erase(0, 2 + extra + length);
          return out;
        }
      }
    }
    if (!receive(until)) return std::nullopt;
  }
}

unsigned Client::Frame::close_code() const {
  if (opcode != 8 || payload.size() < 2) return 0;
  return static_cast<unsigned char>(payload[0]) * 256u + static_cast<unsigned char>(payload[1]);
}

bool Client::send_frame(int opcode, std::string_view payload) {
  std::string out(1, static_cast<char>(0x80 | opcode));
  if (payload.size() < 126) {
    out.push_back(static_cast<char>(0x80 | payload.size()));
  } else {
    const bool small = payload.size() <= 0xffff;
    out.push_back(static_cast<char>(0x80 | (small ? 126 : 127)));
    for (int i = small ? 1 : 7; i >= 0; --i) {
      out.push_back(static_cast<char>(payload.size() >> (8 * i) & 0xff));
    }
  }
  out.append(4, '\0');  // masked with zeros
  return send(out.append(payload));
}

}  // namespace roverd::test
