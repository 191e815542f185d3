#include "link/replay_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "link/candump.hpp"
#include "link/record_file.hpp"
#include "link/recording.hpp"

namespace roverd::link {
namespace {

using base::Bytes;
using base::Code;
using base::Duration;
using MaybeDue = base::Result<std::optional<Duration>>;

constexpr std::size_t kLongestLine = 4096;
/// Of a plain file that nothing cuts: small enough to keep the fallback rate even.
constexpr std::size_t kRatedPiece = 256;
constexpr std::size_t kReadSize = 64 * 1024;

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

base::Result<void> ReplayFile::open_first() {
  playing_ = path_;
  number_ = 1;
  std::error_code ec;
  const auto status = std::filesystem::status(path_, ec);
  if (!std::filesystem::exists(status)) {
    return base::fail(Code::NotFound, "replay file " + path_ + " does not exist");
  }
  if (std::filesystem::is_directory(status)) {
    return base::fail(Code::Invalid, "replay file " + path_ + " is a folder");
  }
  file_ = std::ifstream(path_, std::ios::binary);
  if (!file_) return base::fail(Code::Unavailable, "replay file " + path_ + " cannot be read");
  return {};
}

base::Result<bool> ReplayFile::open_next() {
  const std::string next = numbered_file(path_, number_ + 1);
  std::error_code ec;
  if (!std::filesystem::is_regular_file(next, ec)) return false;
  ++number_;
  playing_ = next;
  file_ = std::ifstream(next, std::ios::binary);
  if (!file_) return base::fail(Code::Unavailable, "replay file " + next + " cannot be read");
  return true;
}

std::vector<std::string> ReplayFile::parts_of(const std::string& first) {
  std::vector<std::string> out{first};
  std::error_code ec;
  for (int n = 2;; ++n) {
    std::string next = numbered_file(first, n);
    if (!std::filesystem::is_regular_file(next, ec)) return out;
    out.push_back(std::move(next));
  }
}

FrameFile::FrameFile(std::string path, Receiver receiver)
    : ReplayFile(std::move(path)), receiver_(std::move(receiver)) {}

base::Result<void> FrameFile::open() {
  if (auto begun = rewind(); !begun) return begun;
  const auto first = advance();
  if (!first) return tl::unexpected(first.error());
  if (!*first) return base::fail(Code::Invalid, "replay file " + path_ + " holds no CAN frames");
  return rewind();
}

base::Result<void> FrameFile::rewind() {
  if (auto opened = open_first(); !opened) return opened;
  line_ = 0;
  last_stamp_.reset();
  at_ = Duration::zero();
  return {};
}

MaybeDue FrameFile::advance() {
  for (;;) {
    const auto read = read_line();
    if (!read) return tl::unexpected(read.error());
    if (*read == Line::Frame) return at_;
    if (*read == Line::Skip) continue;
    const auto next = open_next();
    if (!next) return tl::unexpected(next.error());
    if (!*next) return std::nullopt;
    line_ = 0;
  }
}

base::Result<FrameFile::Line> FrameFile::read_line() {
  std::array<char, kLongestLine> buffer{};
  file_.getline(buffer.data(), buffer.size());
  const bool cut_off = file_.eof();
  if (cut_off && file_.gcount() == 0) return Line::End;
  ++line_;
  const std::string where = "replay file " + playing_ + " line " + std::to_string(line_) + ": ";
  if (file_.bad()) return base::fail(Code::Unavailable, where + "cannot be read");
  if (!cut_off && file_.fail()) {
    return base::fail(Code::Malformed, where + "too long for a CAN frame");
  }
  const auto count = static_cast<std::size_t>(file_.gcount()) - (cut_off ? 0 : 1);
  const auto record = parse_candump_line({buffer.data(), count});
  if (!record) {
    if (cut_off) return Line::End;
    return base::fail(Code::Malformed, where + record.error().detail,
                      {{"line " + std::to_string(line_), record.error().detail}});
  }
  if (!*record) return Line::Skip;
  if ((*record)->stamp) {
    if (!last_stamp_) first_stamp_ = (*record)->stamp;
    at_ += step_to(*(*record)->stamp, last_stamp_);
  }
  if ((*record)->sent) return Line::Skip;
  frame_ = (*record)->frame;
  return Line::Frame;
}

ByteFile::ByteFile(std::string path, ReplayOptions options, Receiver receiver, Receiver sent)
    : ReplayFile(std::move(path)),
      options_(std::move(options)),
      receiver_(std::move(receiver)),
      sent_(std::move(sent)) {}

base::Result<void> ByteFile::open() {
  return rewind();
}

base::Result<void> ByteFile::rewind() {
  if (auto opened = open_first(); !opened) return opened;
  last_stamp_.reset();
  marks_.clear();
  readings_ = {};
  at_ = Duration::zero();
  return begin_file();
}

base::Result<void> ByteFile::begin_file() {
  buffer_.clear();
  begin_ = 0;
  offset_ = 0;
  chunk_sent_ = false;
  capture_.reset();
  datagrams_.clear();
  if (!fill()) return base::fail(Code::Invalid, "replay file " + playing_ + " is empty");
  if (buffer_.size() >= 4 && pcap::begins_capture(Bytes(buffer_).first(4))) return begin_capture();
  const std::string_view start(reinterpret_cast<const char*>(buffer_.data()), buffer_.size());
  if (!start.starts_with(kRecordingMagic)) {
    if (playing_ == path_) return begin_plain();
    return base::fail(Code::Malformed, "replay file " + playing_ + " is no recording");
  }
  pace_ = Pace::Stamped;
  const auto header = read_recording_header(rest());
  if (header.state == RecordingStep::State::Bad) {
    return base::fail(Code::Malformed, "replay file " + playing_ + " line 1: " + header.problem);
  }
  take(header.used);
  return {};
}

base::Result<void> ByteFile::begin_capture() {
  pace_ = Pace::Stamped;
  capture_.emplace([this](const pcap::Datagram& d) {
    if (d.payload.empty()) return;
    datagrams_.push_back({d.stamp.time_since_epoch(), {d.payload.begin(), d.payload.end()}});
  });
  const auto fed = capture_->feed(rest());
  take(rest().size());
  if (fed || !datagrams_.empty()) return {};  // what is wrong later is told there
  return base::fail(Code::Malformed, "replay file " + playing_ + " " + fed.error().detail,
                    fed.error().fields);
}

/// The file that this recording goes on in. @return false: there is none.
base::Result<bool> ByteFile::follow() {
  auto next = open_next();
  if (!next || !*next) return next;
  if (auto begun = begin_file(); !begun) return tl::unexpected(begun.error());
  return true;
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

base::Result<void> ByteFile::begin_plain() {
  clock_ = options_.make_clock ? options_.make_clock() : base::StreamClock();
  if (clock_) clock_(buffer_, [this](const base::StreamMark& mark) { marks_.push_back(mark); });
  const bool told =
      std::ranges::any_of(marks_, [](const auto& mark) { return mark.time.has_value(); });
  pace_ = told ? Pace::Clocked : Pace::Rated;
  return {};
}

/// More of a plain file, and where it may be cut. @return false at the end of the file.
bool ByteFile::read_on() {
  const std::size_t old = rest().size();
  if (!fill()) return false;
  if (clock_) {
    clock_(rest().subspan(old), [this](const base::StreamMark& mark) { marks_.push_back(mark); });
  }
  return true;
}

MaybeDue ByteFile::advance() {
  if (capture_) return advance_capture();
  if (pace_ == Pace::Stamped) return advance_recording();
  return advance_plain();
}

MaybeDue ByteFile::advance_recording() {
  for (;;) {
    const auto step = next_record(rest());
    switch (step.state) {
      case RecordingStep::State::NeedMore:
        if (fill()) continue;
        if (auto next = follow(); !next || !*next) {
          return next ? MaybeDue(std::nullopt) : tl::unexpected(next.error());
        }
        continue;
      case RecordingStep::State::Bad: {
        const std::string where = "byte " + std::to_string(offset_);
        return base::fail(Code::Malformed,
                          "replay file " + playing_ + " " + where + ": " + step.problem,
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

MaybeDue ByteFile::advance_capture() {
  while (datagrams_.empty()) {
    const auto fed = capture_->feed(rest());  // of nothing: what was wrong before
    take(rest().size());
    if (!fed) {
      return base::fail(Code::Malformed, "replay file " + playing_ + " " + fed.error().detail,
                        fed.error().fields);
    }
    if (!datagrams_.empty() || fill()) continue;
    if (auto next = follow(); !next || !*next) {  // a record that was cut off counts as the end
      return next ? MaybeDue(std::nullopt) : tl::unexpected(next.error());
    }
  }
  Datagram next = std::move(datagrams_.front());
  datagrams_.pop_front();
  if (!last_stamp_) first_stamp_ = next.stamp;
  at_ += step_to(next.stamp, last_stamp_);
  chunk_ = std::move(next.bytes);
  return at_;
}

/// Bytes up to where the next message ends, with the line end behind it: a line is none before.
/// 0: nothing is left. @param time what the message says.
std::size_t ByteFile::next_piece(std::optional<base::StreamTime>& time) {
  if (!clock_) {
    while (rest().size() < kRatedPiece && fill()) {
    }
    return std::min(rest().size(), kRatedPiece);
  }
  for (;;) {
    while (!marks_.empty() && marks_.front().end <= offset_) marks_.pop_front();
    if (marks_.empty()) {
      if (read_on()) continue;
      return rest().size();
    }
    std::size_t size = marks_.front().end - offset_;
    if (size + 2 > rest().size() && read_on()) continue;
    time = marks_.front().time;
    marks_.pop_front();
    while (size < rest().size() && (rest()[size] == '\r' || rest()[size] == '\n')) ++size;
    return size;
  }
}

std::optional<Duration> ByteFile::advance_plain() {
  std::optional<base::StreamTime> time;
  const std::size_t size = next_piece(time);
  if (size == 0) return std::nullopt;
  if (pace_ == Pace::Rated) {
    const double rate = std::max(options_.fallback_bytes_per_s, 1.0);
    at_ += base::from_seconds(static_cast<double>(size) / rate);
  } else if (time) {
    wait_for(*time);
  }
  const Bytes piece = rest().first(size);
  chunk_.assign(piece.begin(), piece.end());
  take(size);
  return at_;
}

void ByteFile::wait_for(const base::StreamTime& time) {
  if (!std::isfinite(time.s)) return;
  auto& last = readings_[static_cast<std::size_t>(time.clock)];
  if (!last) {
    last = Reading{time.s, at_};
    return;
  }
  double step_s = time.s - last->s;
  if (step_s < -time.period_s / 2) step_s += time.period_s;  // midnight
  if (step_s <= 0.0 && step_s > -kLate_s) return;
  if (step_s < 0.0 || step_s > kSet_s) {
    last = Reading{time.s, at_};
    return;
  }
  const Duration longest = at_ + base::from_seconds(std::max(options_.longest_gap_s, 0.0));
  last = Reading{time.s, std::min(last->at + base::from_seconds(step_s), longest)};
  at_ = std::max(at_, last->at);
}

}  // namespace roverd::link
