#pragma once
// The pictures out of a body of multipart/x-mixed-replace (RFC 2046, section 5.1).
//
//   Line ──"--boundary"──▶ Head ──empty line──▶ Sized ──Content-Length bytes──▶ Line
//                            └─ no length ─────▶ Open  ──"\n--boundary"───────▶ Head
//
// Cameras write the boundary as they like ("--x" in the header and in the body, "----x"): the first
// line that begins with two dashes is it, whatever was announced. A length that lies spoils its own
// part, and the next ones are found by their boundary. Pure state; what is kept is bounded.

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "base/time.hpp"

namespace roverd::camera {

using base::Bytes;
using base::Time;

inline constexpr std::size_t kMaxPicture = 4'000'000;  ///< bytes

/// @param began when the first byte of it came.
using OnPart = std::function<void(Bytes bytes, Time began)>;

class Parts {
 public:
  static constexpr std::size_t kMaxLine = 1024;
  static constexpr std::size_t kMaxBoundary = 200;

  void feed(Bytes bytes, Time now, const OnPart& on_part);
  /// By cause, since the start.
  const std::map<std::string, std::uint64_t>& refused() const noexcept { return refused_; }

 private:
  enum class State { Line, Head, Sized, Open };

  std::size_t take_line(Bytes rest);
  std::size_t take_sized(Bytes rest, Time now, const OnPart& on_part);
  void take_open(Bytes rest, Time now, const OnPart& on_part);
  void on_line(const std::string& line);
  void on_header(const std::string& line);
  void begin_body();
  void end_body(Bytes bytes, const OnPart& on_part);
  bool is_boundary(std::string_view line) const noexcept;

  State state_ = State::Line;
  std::string line_;
  std::string boundary_;  ///< without its dashes
  std::vector<std::uint8_t> body_;
  std::size_t length_ = 0;     ///< announced; 0: it was not
  std::size_t left_ = 0;       ///< of a sized body
  std::size_t looked_at_ = 0;  ///< of body_, for a boundary
  bool wanted_ = true;         ///< false: of another type, or too large
  bool known_type_ = false;
  Time began_{};
  std::map<std::string, std::uint64_t> refused_;
};

}  // namespace roverd::camera
