#include "sim/port.hpp"

#include <charconv>

#include "link/tcp.hpp"
#include "link/udp.hpp"
#include "sim/pty.hpp"

namespace roverd::sim {
namespace {

constexpr const char* kHere = "127.0.0.1";

std::unique_ptr<link::ByteLink> make_link(boost::asio::io_context& io, const PortSpec& spec) {
  if (spec.kind == PortSpec::Kind::Udp) return std::make_unique<link::UdpLink>(io, spec.port);
  if (spec.kind == PortSpec::Kind::Pty) return std::make_unique<Pty>(io, spec.path);
  return std::make_unique<link::TcpServer>(io, kHere, spec.port);
}

}  // namespace

base::Result<PortSpec> read_port(const std::string& text) {
  const auto colon = text.find(':');
  const std::string word = text.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : text.substr(colon + 1);
  const bool bare = colon == std::string::npos;
  PortSpec spec;
  if (word == "pty" && (bare || !rest.empty())) {
    spec.kind = PortSpec::Kind::Pty;
    spec.path = rest;
    return spec;
  }
  const char* end = rest.data() + rest.size();
  const auto [ptr, ec] = std::from_chars(rest.data(), end, spec.port);
  const bool good = bare || (ec == std::errc{} && ptr == end);
  if ((word != "udp" && word != "tcp") || !good) {
    return base::fail(base::Code::Invalid, "must be udp:PORT, tcp:PORT or pty:PATH");
  }
  spec.kind = word == "udp" ? PortSpec::Kind::Udp : PortSpec::Kind::Tcp;
  return spec;
}

Port::Port(boost::asio::io_context& io, const PortSpec& spec)
    : spec_(spec), link_(make_link(io, spec)) {}

base::Result<void> Port::open() {
  link_->on_bytes = [this](base::Bytes b, base::Time) {
    if (on_bytes) on_bytes(b);
  };
  if (auto done = link_->open(); !done) return done;
  address_ = link_->describe();
  if (const auto* udp = dynamic_cast<const link::UdpLink*>(link_.get())) {
    address_ = std::string("udp:") + kHere + ":" + std::to_string(udp->port());
  }
  return {};
}

void Port::close() noexcept {
  link_->close();
}

void Port::write(base::Bytes bytes) noexcept {
  link_->write(bytes);
}

std::string Port::address() const {
  return address_;
}

void Port::cut(bool off) {
  if (off == cut_ || spec_.kind != PortSpec::Kind::Tcp) return;
  if (off) {
    link_->close();
    cut_ = true;
  } else {
    cut_ = !link_->open();  // refused: tried again with the next step
  }
}

}  // namespace roverd::sim
