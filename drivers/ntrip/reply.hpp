#pragma once
// What a caster answers, of either protocol version, to a stream of corrections or a reason why
// there is none.
//
//   Head ─"ICY 200 OK", HTTP 200─▶ Stream ─end of chunks─▶ Ended
//     ├──"SOURCETABLE 200 OK", HTTP 200 with a table─▶ Table ─ENDSOURCETABLE─▶ Ended
//     └──anything else─▶ Refused; HTTP 401 at the end of its head, which may ask for a Digest
//
// A version 1 caster may send data right after its first line. Pure state; what is kept is bounded.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.hpp"
#include "ntrip/digest.hpp"

namespace roverd::ntrip {

using base::Bytes;

/// One row STR of a source table; rows are often incomplete.
struct Source {
  std::string mountpoint;
  std::string format;                  ///< "RTCM 3.2"
  std::string systems;                 ///< "GPS+GLO+GAL"
  bool wants_gga = false;              ///< the caster has to be told where we are
  std::string place{};                 ///< next town
  std::string country{};               ///< "EST"
  std::optional<double> lat{}, lon{};  ///< degrees; of a network's mountpoint often none
  char login = 'N';                    ///< N none, B basic, D digest
};

/// @param line of a source table. @return empty mountpoint: not a stream.
Source parse_source(std::string_view line);

class Reply {
 public:
  static constexpr std::size_t kMaxHead = 8192;
  static constexpr std::size_t kMaxLine = 2048;
  static constexpr std::size_t kMaxSources = 2000;

  enum class State { Head, Stream, Table, Refused, Ended };

  /// @param on_data called with Bytes of the stream.
  template <class OnData>
  void feed(Bytes bytes, OnData&& on_data) {
    for (std::size_t at = 0; at < bytes.size();) {
      const Step step = take(bytes.subspan(at));
      at += step.used;
      if (step.data > 0) on_data(bytes.subspan(at, step.data));
      at += step.data;
    }
  }

  State state() const noexcept { return state_; }
  /// 1 or 2, of the caster; 0: not known yet.
  int version() const noexcept { return version_; }
  /// Refused: why, in words for people; what the caster said is quoted with printable characters.
  const std::string& refusal() const noexcept { return refusal_; }
  bool unauthorized() const noexcept { return unauthorized_; }
  /// Of an unauthorized one: how the login is wanted instead; empty: not told, or not by Digest.
  const std::optional<Challenge>& challenge() const noexcept { return challenge_; }
  const std::vector<Source>& sources() const noexcept { return sources_; }

 private:
  /// So many bytes are digested, so many after them are of the stream.
  struct Step {
    std::size_t used = 0;
    std::size_t data = 0;
  };
  enum class Chunk { None, Size, Body };

  Step take(Bytes rest);
  void on_line(const std::string& line);
  void on_status(const std::string& line);
  void on_header(const std::string& line);
  void head_ends();
  void on_chunk_size(const std::string& line);
  void refuse(const std::string& why);

  State state_ = State::Head;
  int version_ = 0;
  std::string line_;  ///< as far as it came
  std::size_t head_bytes_ = 0;
  bool status_seen_ = false;
  bool icy_ = false;  ///< data may follow without an empty line
  bool table_ = false;
  bool chunked_ = false;
  Chunk chunk_ = Chunk::None;
  std::size_t left_ = 0;  ///< bytes of this chunk
  bool unauthorized_ = false;
  std::optional<Challenge> challenge_;
  std::string refusal_;
  std::vector<Source> sources_;
};

}  // namespace roverd::ntrip
