#pragma once
// One HTTP/1.1 connection, request after request. What a client sends ahead (pipelining) waits in
// the buffer: one request is answered before the next is read.
//
//   Waiting ─TLS's first byte─▶ Greeting ─handshake─▶ Waiting   (only where TLS is spoken)
//   Waiting ─bytes─▶ Header ─▶ Body ─whole─▶ Handling ─answer─▶ Writing ─keep-alive─▶ Waiting
//                      │ upgrade ▶ Session                          └─close─▶ Lingering ▶ gone
//                      └ refused (4xx, then close) ─▶ Writing
//
// What is urgent without its body is handled at its header. On the reserve (server.hpp) nothing
// else is, and every answer is the last.
//
// How old a request is counts from the first sign of it: the opening of a new connection, the first
// byte on one that was kept, under TLS the end of the handshake, the request before for one that
// was sent ahead of its turn.
//
// Where TLS is spoken, a client that begins without it is told so at its header, by on_plain.
//
// Lingering: after the last answer the write side is shut and what still comes is thrown away for
// a moment, because closing at once would reset the connection and destroy the answer on its way.

#include <memory>
#include <optional>
#include <string>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/serializer.hpp>

#include "net/peers.hpp"
#include "net/wire.hpp"

namespace roverd::net {

class Connection : public Peer, public std::enable_shared_from_this<Connection> {
 public:
  Connection(std::shared_ptr<Peers> peers, Wire wire);
  ~Connection() override;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void start(bool reserve);
  /// Says no without reading anything.
  void refuse(unsigned status, std::string_view detail);

  void sweep(base::Time now) override;
  void stop() override;
  void force() override;
  std::optional<base::Time> gives_way() const override;
  /// What the handler says; nothing if the connection has been closed meanwhile.
  void on_answer(Response response);
  bool on_reserve() const override { return reserve_ && wire_.is_open(); }

 private:
  using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;
  using Serializer = boost::beast::http::response_serializer<boost::beast::http::string_body>;
  enum class Phase { Waiting, Greeting, Header, Body, Handling, Writing, Lingering };

  void greet();
  void greeted();
  void be_patient();
  void wait();
  void read_header();
  void look_at_ends();
  void or_refuse(void (Connection::*step)());
  void on_header();
  bool admit_body();
  void release_body();
  bool admit_answer(Response& response);
  void discard(std::string& body) const;
  void expect_continue();
  void read_body();
  void on_request();
  bool on_read_error(boost::system::error_code ec);
  void upgrade();
  void answer(Response response);
  void write();
  void on_written();
  void linger();
  void discard();

  std::shared_ptr<Peers> peers_;
  Wire wire_;
  boost::beast::flat_buffer buffer_;
  std::optional<Parser> parser_;
  std::optional<Response> response_;
  std::optional<Serializer> serializer_;
  Phase phase_ = Phase::Waiting;
  base::Time begun_;                    ///< of the request being read, as Handlers::on_request says
  std::optional<base::Time> earliest_;  ///< the next request may have come in then already
  base::Time whole_;                    ///< when the last request was in
  std::optional<base::Time> deadline_;
  bool head_ = false;
  bool keep_alive_ = true;
  unsigned version_ = 11;
  std::size_t discarded_ = 0;
  std::size_t body_limit_ = 0;
  std::size_t reserved_ = 0;  ///< counted in Peers::bodies
  std::size_t leaving_ = 0;   ///< counted in Peers::answers
  bool reserve_ = false;
  std::string peer_;          ///< address of the other end
  std::string here_;          ///< and of this one
  bool in_the_open_ = false;  ///< no TLS where there should be
};

}  // namespace roverd::net
