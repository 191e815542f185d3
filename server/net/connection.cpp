#include "net/connection.hpp"

#include <array>
#include <chrono>
#include <memory>
#include <new>
#include <thread>
#include <utility>

#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "base/same_word.hpp"
#include "net/address.hpp"
#include "net/arrival.hpp"
#include "net/framing.hpp"
#include "net/http_date.hpp"
#include "net/session.hpp"

namespace roverd::net {

namespace http = boost::beast::http;
using boost::asio::ip::tcp;
using boost::system::error_code;

namespace {

constexpr std::size_t kReadBytes = 8 * 1024;
/// At once into the socket: others have their turn in between.
constexpr std::size_t kWriteBytes = 256 * 1024;
/// Larger ones are counted, and freed elsewhere.
constexpr std::size_t kLargeBody = 64 * 1024;
/// Header fields are read before it is known what they ask for.
constexpr std::size_t kLargestBody = std::size_t{1} << 40U;
constexpr base::Duration kLinger = std::chrono::seconds(2);
constexpr base::Duration kLingerOnReserve = std::chrono::milliseconds(250);
/// For a header, in a crowded house.
constexpr base::Duration kHeaderInACrowd = std::chrono::seconds(2);
constexpr std::size_t kDiscardBytes = 64 * 1024 * 1024;

/// An answer that never has a body (RFC 9110, section 6.4.1).
bool bodyless(http::status status) {
  return status == http::status::no_content || status == http::status::not_modified ||
         http::to_status_class(status) == http::status_class::informational;
}

/// Held by who is to answer: on whichever thread it is let go of, the connection ends on its own.
class Homing {
 public:
  Homing(std::shared_ptr<Connection> connection, boost::asio::io_context& home)
      : box_(std::make_shared<Box>(std::move(connection))), home_(home) {}
  ~Homing() {
    if (home_.get_executor().running_in_this_thread()) return;
    while (!sent_home()) std::this_thread::sleep_for(kMemoryComesBack);
  }
  Homing(const Homing&) = delete;
  Homing& operator=(const Homing&) = delete;

  Connection& connection() const noexcept { return **box_; }

 private:
  using Box = std::shared_ptr<Connection>;
  static constexpr std::chrono::milliseconds kMemoryComesBack{20};

  /// The box is emptied there: what is left of it here is never the last reference.
  bool sent_home() const noexcept {
    try {
      boost::asio::post(home_, [box = box_] { box->reset(); });
      return true;
    } catch (...) {
      return false;
    }
  }

  std::shared_ptr<Box> box_;
  boost::asio::io_context& home_;
};

}  // namespace

Connection::Connection(std::shared_ptr<Peers> peers, Wire wire)
    : peers_(std::move(peers)),
      wire_(std::move(wire)),
      buffer_(peers_->limits.header_bytes + 64 * 1024) {}

Connection::~Connection() {
  release_body();
  peers_->answers -= leaving_;
  if (parser_) discard(parser_->get().body());
  if (response_) discard(response_->body());
  peers_->remove(this);
}

void Connection::start(bool reserve) {
  reserve_ = reserve;
  error_code ignored;
  wire_.socket().set_option(tcp::no_delay(true), ignored);
  earliest_ = peers_->not_seen_since(opened_at(wire_.handle(), base::steady_now()));
  if (peers_->tls) return greet();
  wait();
}

/// Does the client begin with TLS?
void Connection::greet() {
  be_patient();
  wire_.when_readable([self = shared_from_this()](error_code ec) {
    if (ec) return self->force();
    self->greeted();
  });
}

void Connection::greeted() {
  switch (wire_.first()) {
    case Wire::First::None:
      return greet();
    case Wire::First::Gone:
      return force();
    case Wire::First::Plain:
      in_the_open_ = true;
      return wait();
    case Wire::First::Tls:
      break;
  }
  phase_ = Phase::Greeting;  // it has the time of a header
  if (!reserve_) deadline_ = base::steady_now() + peers_->limits.request;
  wire_.shake(*peers_->tls, [self = shared_from_this()](error_code ec) {
    if (ec) return self->force();
    self->earliest_ = self->peers_->not_seen_since(self->wire_.shaken_after());
    self->wait();
  });
}

/// On the reserve handshake and header have their time together.
void Connection::be_patient() {
  phase_ = Phase::Waiting;
  if (reserve_ && deadline_) return;
  const auto& limits = peers_->limits;
  deadline_ = base::steady_now() + (reserve_ ? limits.reserve_time : limits.idle);
}

void Connection::wait() {
  be_patient();
  if (buffer_.size() > 0) return read_header();
  wire_.async_read_some(buffer_.prepare(kReadBytes),
                        [self = shared_from_this()](error_code ec, std::size_t n) {
                          if (ec) return self->force();
                          self->buffer_.commit(n);
                          self->read_header();
                        });
}

void Connection::read_header() {
  phase_ = Phase::Header;
  const base::Time now = base::steady_now();
  begun_ = earliest_ ? *earliest_ : peers_->not_seen_since(newest_arrival(wire_.handle(), now));
  earliest_.reset();
  if (!reserve_) deadline_ = now + peers_->limits.request;
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(peers_->limits.header_bytes));
  parser_->body_limit(kLargestBody);
  body_limit_ = peers_->limits.body_bytes;
  http::async_read_header(wire_, buffer_, *parser_,
                          [self = shared_from_this()](error_code ec, std::size_t) {
                            if (self->on_read_error(ec)) return;
                            self->or_refuse(&Connection::on_header);
                          });
}

/// @return true if that was the end of reading; a broken request has then been answered.
bool Connection::on_read_error(error_code ec) {
  if (!ec) return false;
  if (ec == http::error::header_limit || ec == http::error::buffer_overflow) {
    refuse(431,
           "the header is larger than " + std::to_string(peers_->limits.header_bytes) + " bytes");
  } else if (ec == http::error::body_limit) {
    refuse(413, "the body is larger than " + std::to_string(body_limit_) + " bytes");
  } else if (ec == http::error::end_of_stream || ec == http::error::partial_message ||
             ec.category() != make_error_code(http::error::end_of_stream).category()) {
    force();  // the client left, or its deadline passed
  } else {
    refuse(400, "not an HTTP request: " + ec.message());
  }
  return true;
}

/// Once, while the client is there.
void Connection::look_at_ends() {
  error_code ignored;
  peer_ = address_text(wire_.socket().remote_endpoint(ignored).address());
  here_ = address_text(wire_.socket().local_endpoint(ignored).address());
}

/// Where it finds no memory the client is told so; what was set aside for that moment is free now.
void Connection::or_refuse(void (Connection::*step)()) {
  try {
    (this->*step)();
  } catch (const std::bad_alloc&) {
    if (phase_ == Phase::Writing || !wire_.is_open()) return force();
    refuse(503, "there is no memory for this request now; try again");
  }
}

void Connection::on_header() {
  auto& request = parser_->get();
  if (peer_.empty()) look_at_ends();
  request.set(boost::beast::string_view(kPeerHeader.data(), kPeerHeader.size()), peer_);
  request.set(boost::beast::string_view(kHereHeader.data(), kHereHeader.size()), here_);
  head_ = request.method() == http::verb::head;
  keep_alive_ = request.keep_alive() && !peers_->stopping;
  version_ = request.version();
  if (in_the_open_) {
    keep_alive_ = false;
    phase_ = Phase::Handling;
    return answer(peers_->handlers.on_plain
                      ? peers_->handlers.on_plain(request)
                      : peers_->refusal(403, "only TLS is spoken here: https"));
  }
  if (const auto wrong = framing_fault(request)) return refuse(wrong->status, wrong->detail);
  if (boost::beast::websocket::is_upgrade(request)) return upgrade();
  const Urgency urgency =
      peers_->handlers.urgency ? peers_->handlers.urgency(request) : Urgency::None;
  if (reserve_ && urgency == Urgency::None) {
    return refuse(503, "too many connections: only what stops is served now");
  }
  if (urgency == Urgency::AtHeader) {
    const auto length = parser_->content_length();
    if (parser_->chunked() || (length && *length > buffer_.size())) {
      keep_alive_ = false;  // what comes of the body is thrown away
      return on_request();
    }
  }
  phase_ = Phase::Body;
  if (!admit_body()) return;
  const auto expect = request[http::field::expect];
  if (expect.empty() || version_ < 11) return read_body();
  if (!base::same_word({expect.data(), expect.size()}, "100-continue")) {
    return refuse(417, "the only expectation understood is 100-continue");
  }
  expect_continue();
}

/// @return false: refused, for its length or because too much is being worked on.
bool Connection::admit_body() {
  if (peers_->handlers.body_limit) body_limit_ = peers_->handlers.body_limit(parser_->get());
  parser_->body_limit(body_limit_);
  const auto length = parser_->content_length();
  if (length && *length > body_limit_) {
    on_read_error(http::error::body_limit);
    return false;
  }
  const std::size_t most = length ? static_cast<std::size_t>(*length) : body_limit_;
  const bool sends = length ? most > 0 : parser_->chunked();
  if (!sends || most <= kLargeBody) return true;
  if (peers_->bodies + most > peers_->limits.all_bodies_bytes) {
    refuse(503, "too many large bodies at the same time; try again");
    return false;
  }
  try {
    parser_->get().body().reserve(most);  // growing would copy it again and again
  } catch (const std::bad_alloc&) {
    refuse(503, "there is no memory for a body of " + std::to_string(most) + " bytes now");
    return false;
  }
  peers_->bodies += reserved_ = most;
  *deadline_ += std::chrono::seconds(most / kSlowest_Bps);
  return true;
}

void Connection::release_body() {
  peers_->bodies -= reserved_;
  reserved_ = 0;
}

/// Clients that ask for much and read slowly must not fill the memory. @return false: too much
bool Connection::admit_answer(Response& response) {
  const std::size_t bytes = response.body().size();
  if (bytes <= kLargeBody) return true;
  if (peers_->answers + bytes > peers_->limits.all_answers_bytes) {
    discard(response.body());
    return false;
  }
  peers_->answers += leaving_ = bytes;
  return true;
}

void Connection::discard(std::string& body) const {
  if (body.size() > kLargeBody && peers_->handlers.discard) {
    peers_->handlers.discard(std::move(body));
  }
}

void Connection::expect_continue() {
  static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  boost::asio::async_write(wire_, boost::asio::buffer(kContinue),
                           [self = shared_from_this()](error_code ec, std::size_t) {
                             if (ec) return self->force();
                             self->read_body();
                           });
}

void Connection::read_body() {
  if (parser_->is_done()) return on_request();
  http::async_read(wire_, buffer_, *parser_,
                   [self = shared_from_this()](error_code ec, std::size_t) {
                     if (self->on_read_error(ec)) return;
                     self->or_refuse(&Connection::on_request);
                   });
}

void Connection::on_request() {
  phase_ = Phase::Handling;
  deadline_.reset();  // the handler keeps its own time
  whole_ = base::steady_now();
  ++peers_->stats.requests;
  if (!peers_->handlers.on_request) return force();
  peers_->handlers.on_request(
      parser_->release(), begun_,
      [homing = std::make_shared<Homing>(shared_from_this(), peers_->io)](Response response) {
        homing->connection().on_answer(std::move(response));
      });
}

void Connection::upgrade() {
  phase_ = Phase::Handling;
  deadline_.reset();
  ++peers_->stats.requests;
  Request request = parser_->release();
  if (!peers_->handlers.on_upgrade) return force();
  if (auto refusal = peers_->handlers.on_upgrade(request)) return answer(std::move(*refusal));
  const auto bytes = buffer_.cdata();
  std::string early(static_cast<const char*>(bytes.data()), bytes.size());
  const auto session = std::make_shared<Session>(
      peers_, std::move(wire_), std::move(early),
      reserve_ ? std::optional(base::steady_now() + peers_->limits.reserve_time) : std::nullopt);
  peers_->add(session.get(), session, peers_->from_of(this));
  session->accept(std::move(request));
}

void Connection::refuse(unsigned status, std::string_view detail) {
  keep_alive_ = false;
  phase_ = Phase::Handling;
  answer(peers_->refusal(status, detail));
}

void Connection::on_answer(Response response) {
  if (phase_ == Phase::Handling) answer(std::move(response));
}

void Connection::answer(Response response) {
  phase_ = Phase::Writing;
  release_body();
  if (!admit_answer(response)) {
    response = peers_->refusal(503, "too many large answers are on their way; try again");
  }
  keep_alive_ = keep_alive_ && !reserve_ && response.keep_alive();
  response.version(version_);
  response.keep_alive(keep_alive_);
  response.set(http::field::date, http_date_now());
  if (bodyless(response.result())) {
    response.body().clear();
    response.erase(http::field::content_length);
  } else {
    response.content_length(response.body().size());
  }
  response_.emplace(std::move(response));
  serializer_.emplace(*response_);
  serializer_->split(head_);
  serializer_->limit(kWriteBytes);
  write();
}

void Connection::write() {
  deadline_ = base::steady_now() + peers_->limits.request;
  const auto next = [self = shared_from_this()](error_code ec, std::size_t) {
    if (ec) return self->force();
    const bool done =
        self->head_ ? self->serializer_->is_header_done() : self->serializer_->is_done();
    if (done) return self->on_written();
    self->write();
  };
  if (head_) {
    http::async_write_header(wire_, *serializer_, next);
  } else {
    http::async_write_some(wire_, *serializer_, next);
  }
}

void Connection::on_written() {
  serializer_.reset();
  discard(response_->body());
  response_.reset();
  peers_->answers -= std::exchange(leaving_, 0);
  parser_.reset();
  if (!keep_alive_ || peers_->stopping) return linger();
  error_code ignored;
  const bool sent_ahead =
      buffer_.size() > 0 || wire_.holds_input() || wire_.socket().available(ignored) > 0;
  if (sent_ahead) earliest_ = whole_;
  wait();
}

void Connection::linger() {
  phase_ = Phase::Lingering;
  deadline_ = base::steady_now() + (reserve_ ? kLingerOnReserve : kLinger);
  error_code ec;
  wire_.say_goodbye();
  wire_.socket().shutdown(tcp::socket::shutdown_send, ec);
  if (ec) return force();
  buffer_.clear();
  discard();
}

void Connection::discard() {
  // Past TLS: what nobody reads is not opened.
  wire_.socket().async_read_some(buffer_.prepare(64 * 1024),
                                 [self = shared_from_this()](error_code ec, std::size_t n) {
                                   self->discarded_ += n;
                                   if (ec || self->discarded_ > kDiscardBytes) return self->force();
                                   self->discard();
                                 });
}

void Connection::sweep(base::Time now) {
  const bool begins = phase_ == Phase::Header || phase_ == Phase::Greeting;
  const bool dawdles = begins && !reserve_ && peers_->crowded() && deadline_ &&
                       now > *deadline_ - peers_->limits.request + kHeaderInACrowd;
  if (!deadline_ || (now < *deadline_ && !dawdles)) return;
  if (phase_ != Phase::Lingering) ++peers_->stats.timed_out;
  force();
}

void Connection::stop() {
  keep_alive_ = false;
  if (phase_ == Phase::Greeting || phase_ == Phase::Waiting || phase_ == Phase::Lingering) force();
}

void Connection::force() {
  wire_.close();
}

std::optional<base::Time> Connection::gives_way() const {
  if (!wire_.is_open()) return std::nullopt;
  const bool asks_nothing =
      phase_ == Phase::Greeting || phase_ == Phase::Waiting || phase_ == Phase::Header;
  // On the reserve a body that does not come keeps nobody out either.
  const bool lingers = reserve_ && (phase_ == Phase::Lingering || phase_ == Phase::Body);
  return asks_nothing || lingers ? deadline_ : std::nullopt;
}

}  // namespace roverd::net
