#include "camera/answer.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "camera/words.hpp"

namespace roverd::camera {
namespace {

constexpr std::size_t kMaxChunkLine = 256;

/// What a camera said, for people.
std::string as_told(std::string_view text) {
  constexpr std::size_t kLongest = 80;
  std::string out;
  for (const char c : text.substr(0, kLongest)) out += c >= ' ' && c < 0x7F ? c : '?';
  return out;
}

}  // namespace

void Answer::feed(Bytes bytes, Time now, const OnPart& on_part) {
  while (!bytes.empty() && state_ != State::Ended && state_ != State::Refused) {
    if (state_ == State::Head) {
      take_head(bytes[0]);
      bytes = bytes.subspan(1);
    } else if (chunk_ == Chunk::None) {
      return body(bytes, now, on_part);
    } else {
      bytes = bytes.subspan(take_chunk(bytes, now, on_part));
    }
  }
}

void Answer::end(const OnPart& on_part) {
  if (state_ != State::Single || sized_ || chunk_ != Chunk::None) return;
  state_ = State::Ended;
  if (!picture_.empty()) on_part(picture_, began_);
}

void Answer::refuse(std::string why) {
  state_ = State::Refused;
  refusal_ = std::move(why);
}

void Answer::take_head(std::uint8_t byte) {
  if (++head_bytes_ > kMaxHead) return refuse("the head of its answer does not end");
  if (byte != '\n') {
    line_ += static_cast<char>(byte);
    return;
  }
  if (!line_.empty() && line_.back() == '\r') line_.pop_back();
  on_head_line(std::exchange(line_, {}));
}

void Answer::on_head_line(const std::string& line) {
  if (status_ == 0) return on_status(line);
  if (line.empty()) return head_ends();
  if (const auto type = header(line, "content-type")) {
    type_ = lower(*type);
  } else if (const auto place = header(line, "location")) {
    place_ = as_told(*place);
  } else if (const auto coding = header(line, "transfer-encoding")) {
    if (lower(*coding) == "chunked") chunk_ = Chunk::Size;
  } else if (const auto wish = header(line, "www-authenticate")) {
    if (lower(*wish).starts_with("basic")) wish_.basic = true;
    // The first digest that it offers and that can be answered.
    if (!wish_.digest) wish_.digest = ntrip::parse_challenge(*wish);
  } else if (const auto length = header(line, "content-length")) {
    const auto [end, bad] =
        std::from_chars(length->data(), length->data() + length->size(), length_);
    sized_ = bad == std::errc{} && end == length->data() + length->size();
    if (!sized_) refuse("the length of its answer is no number");
  }
}

void Answer::on_status(const std::string& line) {
  const auto blank = line.find(' ');
  const bool http = line.starts_with("HTTP/1.") && blank != std::string::npos;
  if (http) {
    const char* begin = line.data() + blank + 1;
    static_cast<void>(std::from_chars(begin, line.data() + line.size(), status_));
  }
  if (!http || status_ < 100 || status_ > 599) {
    return refuse("it speaks no HTTP: \"" + as_told(line) + "\"");
  }
  if (status_ != 200) refusal_ = as_told(line.substr(blank + 1));
}

void Answer::head_ends() {
  if (status_ >= 300 && status_ < 400) return refuse("it sends to another address: " + place_);
  if (status_ != 200) return refuse("it answers " + refusal_);
  if (type_.starts_with("multipart/")) {
    state_ = State::Stream;
    return;
  }
  if (!type_.starts_with("image/jpeg") && !type_.starts_with("image/jpg")) {
    return refuse("it gives no pictures but " + (type_.empty() ? "nothing" : as_told(type_)));
  }
  single_ = true;
  if (sized_ && chunk_ == Chunk::None && (length_ == 0 || length_ > kMaxPicture)) {
    return refuse(length_ == 0 ? "its picture is empty" : "its picture has more than 4 MB");
  }
  state_ = State::Single;
}

void Answer::body(Bytes bytes, Time now, const OnPart& on_part) {
  if (state_ == State::Stream) return parts_.feed(bytes, now, on_part);
  if (picture_.empty()) began_ = now;
  const std::size_t most = sized_ && chunk_ == Chunk::None ? length_ : kMaxPicture;
  if (bytes.size() > most - picture_.size()) {
    if (most == kMaxPicture) return refuse("its picture has more than 4 MB");
    bytes = bytes.first(most - picture_.size());
  }
  picture_.insert(picture_.end(), bytes.begin(), bytes.end());
  if (!sized_ || chunk_ != Chunk::None || picture_.size() < length_) return;
  state_ = State::Ended;
  on_part(picture_, began_);
}

/// @return bytes that are done with.
std::size_t Answer::take_chunk(Bytes rest, Time now, const OnPart& on_part) {
  if (chunk_ != Chunk::Body) return chunk_line(rest, on_part);
  const std::size_t n = std::min(left_, rest.size());
  left_ -= n;
  if (left_ == 0) chunk_ = Chunk::After;
  body(rest.first(n), now, on_part);
  return n;
}

/// Lines between the chunks, byte by byte.
std::size_t Answer::chunk_line(Bytes rest, const OnPart& on_part) {
  if (rest[0] != '\n') {
    if (line_.size() < kMaxChunkLine) line_ += static_cast<char>(rest[0]);
    return 1;
  }
  const std::string line(trimmed(std::exchange(line_, {})));
  if (chunk_ == Chunk::After) {
    chunk_ = Chunk::Size;
  } else if (chunk_ == Chunk::Size) {
    const auto [end, bad] = std::from_chars(line.data(), line.data() + line.size(), left_, 16);
    if (bad != std::errc{} || end == line.data()) {
      refuse("its chunks make no sense");
    } else {
      chunk_ = left_ > 0 ? Chunk::Body : Chunk::Trailer;
    }
  } else if (line.empty()) {
    const bool whole = state_ == State::Single && !picture_.empty();
    state_ = State::Ended;
    if (whole) on_part(picture_, began_);
  }
  return 1;
}

}  // namespace roverd::camera
