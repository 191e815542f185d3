#include "link/replay_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "link/candump.hpp"
#include "link/recording.hpp"

namespace roverd::link {
namespace {

using base::Bytes;
using base::Code;
using base::Duration;
using MaybeDue = base::Result<std::optional<Duration>>;

constexpr std::size_t kLongestLine = 4096;
constexpr std::size_t kReadSize = 64 * 1024;
constexpr double kDay_s = 86'400.0;

base::Result<void> open_file(std::ifstream& file, const std::string& path) {
  std::error_code ec;
  const auto status = std::filesystem::status(path, ec);
  if (!std::filesystem::exists(status)) {
    return base::fail(Code::NotFound, "replay file " + path + " does not exist");
  }
  if (std::filesystem::is_directory(status)) {
    return base::fail(Code::Invalid, "replay file " + path + " is a folder");
  }
  file = std::ifstream(path, std::ios::binary);
  if (!file) return base::fail(Code::Unavailable, "replay file " + path + " cannot be read");
  return {};
}

/// Time that passes before `stamp`; a stamp that goes back costs none.
Duration step_to(Duration stamp, std::optional<Duration>& last) noexcept {
  const Duration step = last ? std::max(stamp - *last, Duration::zero()) : Duration::zero();
  last = stamp;
  return step;
}

}  // namespace

std::optional<Duration> ReplayFile::begin() const noexcept {
  // A log with times since its own beginning, or between its lines, has small ones.
  constexpr Duration kDated = std::chrono::seconds(1'000'000'000);  // September 2001
  return first_stamp_ && *first_stamp_ >= kDated ? first_stamp_ : std::nullopt;
}

FrameFile::FrameFile(std::string path, Receiver receiver)
    : path_(std::move(path)), receiver_(std::move(receiver)) {}

base::Result<void> FrameFile::open() {
  if (auto opened = open_file(file_, path_); !opened) return opened;
  const auto first = advance();
  if (!first) return tl::unexpected(first.error());
  if (!*first) return base::fail(Code::Invalid, "replay file " + path_ + " holds no CAN frames");
  return rewind();
}

base::Result<void> FrameFile::rewind() {
  file_.clear();
  file_.seekg(0);
  if (!file_) return base::fail(Code::Unavailable, "replay file " + path_ + " cannot be rewound");
  line_ = 0;
  last_stamp_.reset();
  at_ = Duration::zero();
  return {};
}

MaybeDue FrameFile::advance() {
  std::array<char, kLongestLine> buffer;
  for (;;) {
    file_.getline(buffer.data(), buffer.size());
    const bool cut_off = file_.eof();  // the last line has no end
    if (file_.fail() && cut_off) return std::nullopt;
    ++line_;
    const std::string where = "replay file " + path_ + " line " + std::to_string(line_) + ": ";
    if (file_.bad()) return base::fail(Code::Unavailable, where + "cannot be read");
    if (file_.fail()) return base::fail(Code::Malformed, where + "too long for a CAN frame");
    const auto count = static_cast<std::size_t>(file_.gcount()) - (cut_off ? 0 : 1);
    const auto record = parse_candump_line({buffer.data(), count});
    if (!record) {
      if (cut_off) return std::nullopt;
      return base::fail(Code::Malformed, where + record.error().detail,
                        {{"line " + std::to_string(line_), record.error().detail}});
    }
    if (!*record) continue;
    if ((*record)->stamp) {
      if (!last_stamp_) first_stamp_ = (*record)->stamp;
      at_ += step_to(*(*record)->stamp, last_stamp_);
    }
    if ((*record)->sent) continue;
    frame_ = (*record)->frame;
    return at_;
  }
}

ByteFile::ByteFile(std::string path, ReplayOptions options, Receiver receiver, Receiver sent)
    : path_(std::move(path)),
      options_(std::move(options)),
      receiver_(std::move(receiver)),
      sent_(std::move(sent)) {}

base::Result<void> ByteFile::open() {
  if (auto opened = open_file(file_, path_); !opened) return opened;
  return rewind();
}

base::Result<void> ByteFile::rewind() {
  file_.clear();
  file_.seekg(0);
  if (!file_) return base::fail(Code::Unavailable, "replay file " + path_ + " cannot be rewound");
  buffer_.clear();
  begin_ = 0;
  offset_ = 0;
  chunk_sent_ = false;
  last_stamp_.reset();
  last_clock_s_.reset();
  at_ = Duration::zero();
  if (!fill()) return base::fail(Code::Invalid, "replay file " + path_ + " is empty");
  const std::string_view start(reinterpret_cast<const char*>(buffer_.data()), buffer_.size());
  if (!start.starts_with(kRecordingMagic)) {
    pace_ = has_line_clock() ? Pace::Clocked : Pace::Rated;
    return {};
  }
  pace_ = Pace::Stamped;
  const auto header = read_recording_header(rest());
  if (header.state == RecordingStep::State::Bad) {
    return base::fail(Code::Malformed, "replay file " + path_ + " line 1: " + header.problem);
  }
  take(header.used);
  return {};
}

/// Reads on. @return false at the end of the file.
bool ByteFile::fill() {
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
  begin_ = 0;
  const std::size_t old = buffer_.size();
  buffer_.resize(old + kReadSize);
  file_.read(reinterpret_cast<char*>(buffer_.data() + old), kReadSize);
  buffer_.resize(old + static_cast<std::size_t>(file_.gcount()));
  return buffer_.size() > old;
}

void ByteFile::take(std::size_t bytes) {
  begin_ += bytes;
  offset_ += bytes;
}

bool ByteFile::has_line_clock() const {
  if (!options_.line_clock) return false;
  auto at = buffer_.begin();
  while (at != buffer_.end()) {
    const auto end = std::find(at, buffer_.end(), '\n');
    if (options_.line_clock(Bytes(at, end))) return true;
    at = end == buffer_.end() ? end : end + 1;
  }
  return false;
}

MaybeDue ByteFile::advance() {
  if (pace_ == Pace::Stamped) return advance_recording();
  return advance_plain();
}

MaybeDue ByteFile::advance_recording() {
  for (;;) {
    const auto step = next_record(rest());
    switch (step.state) {
      case RecordingStep::State::NeedMore:
        if (!fill()) return std::nullopt;
        continue;
      case RecordingStep::State::Bad: {
        const std::string where = "byte " + std::to_string(offset_);
        return base::fail(Code::Malformed,
                          "replay file " + path_ + " " + where + ": " + step.problem,
                          {{where, step.problem}});
      }
      case RecordingStep::State::Ok:
        break;
    }
    if (!last_stamp_) first_stamp_ = step.record.stamp;
    at_ += step_to(step.record.stamp, last_stamp_);
    chunk_sent_ = step.record.sent;
    const bool wanted = !chunk_sent_ || sent_;
    if (wanted) chunk_.assign(step.record.bytes.begin(), step.record.bytes.end());
    take(step.used);
    if (wanted) return at_;
  }
}

std::optional<Duration> ByteFile::advance_plain() {
  // A piece of binary without a line feed is cut: small enough to keep the fallback rate even.
  const std::size_t longest = pace_ == Pace::Rated ? 256 : kLongestLine;
  while (rest().size() < longest && fill()) {
  }
  const Bytes all = rest().first(std::min(rest().size(), longest));
  if (all.empty()) return std::nullopt;
  const auto feed = std::find(all.begin(), all.end(), '\n');
  const auto content = static_cast<std::size_t>(feed - all.begin());
  const std::size_t size = content + (feed == all.end() ? 0 : 1);
  if (pace_ == Pace::Rated) {
    const double rate = std::max(options_.fallback_bytes_per_s, 1.0);
    at_ += base::from_seconds(static_cast<double>(size) / rate);
  } else {
    wait_for(all.first(content));
  }
  chunk_.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(size));
  take(size);
  return at_;
}

void ByteFile::wait_for(Bytes line) {
  const auto clock_s = options_.line_clock(line);
  if (!clock_s || !std::isfinite(*clock_s)) return;
  if (last_clock_s_) {
    double step_s = *clock_s - *last_clock_s_;
    if (step_s < -kDay_s / 2) step_s += kDay_s;  // midnight
    at_ += base::from_seconds(std::clamp(step_s, 0.0, std::max(options_.longest_gap_s, 0.0)));
  }
  last_clock_s_ = clock_s;
}

}  // namespace roverd::link
