#pragma once
// What an IP camera answers, to pictures or a reason why there are none.
//
//   Head ─200, multipart/…─▶ Stream ─last chunk─▶ Ended
//     ├──200, image/jpeg─▶ Single ─length, last chunk, closed─▶ Ended
//     └──anything else─▶ Refused; of a 401 at the end of its head, which tells how it wants the
//                        login
//
// Source: RFC 9112 (head, chunks). Pure state; what is kept is bounded.

#include <cstdint>
#include <string>
#include <vector>

#include "camera/parts.hpp"
#include "camera/source.hpp"

namespace roverd::camera {

class Answer {
 public:
  static constexpr std::size_t kMaxHead = 16'384;

  enum class State { Head, Stream, Single, Ended, Refused };

  void feed(Bytes bytes, Time now, const OnPart& on_part);
  /// The connection was closed: a single picture without a length is whole.
  void end(const OnPart& on_part);

  State state() const noexcept { return state_; }
  /// It gives one picture, and is to be asked again for the next.
  bool single() const noexcept { return single_; }
  /// Why Refused, printable.
  const std::string& refusal() const noexcept { return refusal_; }
  bool unauthorized() const noexcept { return status_ == 401; }
  const Wish& wish() const noexcept { return wish_; }
  const std::map<std::string, std::uint64_t>& refused() const noexcept { return parts_.refused(); }

 private:
  enum class Chunk { None, Size, Body, After, Trailer };

  void take_head(std::uint8_t byte);
  std::size_t take_chunk(Bytes rest, Time now, const OnPart& on_part);
  std::size_t chunk_line(Bytes rest, const OnPart& on_part);
  void on_head_line(const std::string& line);
  void on_status(const std::string& line);
  void head_ends();
  void body(Bytes bytes, Time now, const OnPart& on_part);
  void refuse(std::string why);

  State state_ = State::Head;
  Chunk chunk_ = Chunk::None;
  bool single_ = false;
  bool sized_ = false;
  int status_ = 0;
  std::size_t head_bytes_ = 0;
  std::size_t left_ = 0;    ///< of a chunk
  std::size_t length_ = 0;  ///< of a single picture, if sized_
  std::string line_;
  std::string type_;
  std::string place_;  ///< of a redirection
  Wish wish_;
  std::string refusal_;
  Parts parts_;
  std::vector<std::uint8_t> picture_;  ///< the single one
  Time began_{};
};

}  // namespace roverd::camera
