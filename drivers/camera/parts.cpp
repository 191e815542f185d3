#include "camera/parts.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>

#include "camera/words.hpp"

namespace roverd::camera {

void Parts::feed(Bytes bytes, Time now, const OnPart& on_part) {
  std::vector<std::uint8_t> again;
  while (!bytes.empty()) {
    if (state_ == State::Open) {
      take_open(bytes, now, on_part);
      if (state_ == State::Open) return;
      // What follows the picture is read again, as lines.
      again.assign(body_.begin() + static_cast<std::ptrdiff_t>(looked_at_), body_.end());
      body_.clear();
      bytes = again;
      continue;
    }
    const std::size_t used =
        state_ == State::Sized ? take_sized(bytes, now, on_part) : take_line(bytes);
    bytes = bytes.subspan(used);
  }
}

std::size_t Parts::take_line(Bytes rest) {
  const auto* end = static_cast<const std::uint8_t*>(std::memchr(rest.data(), '\n', rest.size()));
  const std::size_t n = end != nullptr ? static_cast<std::size_t>(end - rest.data()) : rest.size();
  const std::size_t room = kMaxLine - std::min(line_.size(), kMaxLine);
  line_.append(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(std::min(n, room)));
  if (end == nullptr) return n;
  if (!line_.empty() && line_.back() == '\r') line_.pop_back();
  std::string line;
  line.swap(line_);
  on_line(line);
  return n + 1;
}

/// The boundary may be preceded by more dashes than were meant.
bool Parts::is_boundary(std::string_view line) const noexcept {
  if (!line.starts_with("--")) return false;
  const auto word = line.find_first_not_of('-');
  return word != std::string_view::npos && line.substr(word).starts_with(boundary_);
}

void Parts::on_line(const std::string& line) {
  if (state_ == State::Head) return line.empty() ? begin_body() : on_header(line);
  if (line.empty()) return;
  if (boundary_.empty() && line.starts_with("--")) {
    const std::string_view word = trimmed(std::string_view(line).substr(2));
    const auto begin = word.find_first_not_of('-');
    if (begin != std::string_view::npos) boundary_ = word.substr(begin, kMaxBoundary);
  }
  if (boundary_.empty() || !is_boundary(line)) {
    ++refused_["line outside of any part"];
    return;
  }
  state_ = State::Head;
  length_ = 0;
  known_type_ = false;
  wanted_ = true;
}

void Parts::on_header(const std::string& line) {
  if (const auto value = header(line, "content-length")) {
    std::size_t n = 0;
    const auto [end, bad] = std::from_chars(value->data(), value->data() + value->size(), n);
    if (bad != std::errc{} || end != value->data() + value->size()) {
      ++refused_["part whose length is no number"];
      return;
    }
    length_ = n;
  } else if (const auto type = header(line, "content-type")) {
    known_type_ = true;
    const std::string kind = lower(*type);
    if (!kind.starts_with("image/jpeg") && !kind.starts_with("image/jpg")) {
      wanted_ = false;
      ++refused_["part that is no JPEG"];
    }
  }
}

void Parts::begin_body() {
  body_.clear();
  looked_at_ = 0;
  if (length_ > kMaxPicture) {
    // Whether it says the truth is not waited for: the next boundary is looked for.
    if (wanted_) ++refused_["picture of more than 4 MB"];
    wanted_ = false;
    length_ = 0;
  }
  left_ = length_;
  state_ = length_ > 0 ? State::Sized : State::Open;
}

void Parts::end_body(Bytes bytes, const OnPart& on_part) {
  if (wanted_ && !bytes.empty()) on_part(bytes, began_);
}

std::size_t Parts::take_sized(Bytes rest, Time now, const OnPart& on_part) {
  if (left_ == length_) began_ = now;
  const std::size_t n = std::min(left_, rest.size());
  left_ -= n;
  if (n == length_) {  // at once: no need to keep it
    state_ = State::Line;
    end_body(rest.first(n), on_part);
    return n;
  }
  body_.insert(body_.end(), rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(n));
  if (left_ > 0) return n;
  state_ = State::Line;
  end_body(body_, on_part);
  body_.clear();
  return n;
}

/// Up to a line that is the boundary. Then looked_at_ is where that line begins.
void Parts::take_open(Bytes rest, Time now, const OnPart& on_part) {
  if (body_.empty()) began_ = now;
  body_.insert(body_.end(), rest.begin(), rest.end());
  while (looked_at_ < body_.size()) {
    const auto* from = body_.data() + looked_at_;
    const auto* found =
        static_cast<const std::uint8_t*>(std::memchr(from, '\n', body_.size() - looked_at_));
    if (found == nullptr) {
      looked_at_ = body_.size();
      break;
    }
    const auto at = static_cast<std::size_t>(found - body_.data());
    // Dashes, then the word; more dashes than that is no boundary of anybody.
    constexpr std::size_t kMostDashes = 64;
    const std::size_t enough = kMostDashes + boundary_.size();
    const std::string_view after(reinterpret_cast<const char*>(found) + 1,
                                 std::min(enough, body_.size() - at - 1));
    const bool dashes = std::string_view("--").starts_with(after.substr(0, 2));
    const auto word = after.find_first_not_of('-');
    const std::string_view told = after.substr(std::min(word, after.size()));
    if (dashes && after.size() < enough && told.size() < boundary_.size() &&
        std::string_view(boundary_).starts_with(told)) {
      looked_at_ = at;  // it may become one
      break;
    }
    if (is_boundary(after)) {
      std::size_t end = at;
      if (end > 0 && body_[end - 1] == '\r') --end;
      state_ = State::Line;
      end_body(Bytes(body_).first(end), on_part);
      looked_at_ = at + 1;
      return;
    }
    looked_at_ = at + 1;
  }
  if (looked_at_ <= kMaxPicture) return;
  if (wanted_) ++refused_["picture of more than 4 MB"];
  wanted_ = false;
  body_.erase(body_.begin(), body_.begin() + static_cast<std::ptrdiff_t>(looked_at_));
  looked_at_ = 0;
}

}  // namespace roverd::camera
