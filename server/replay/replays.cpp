#include "replay/replays.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "gnss/nmea.hpp"
#include "link/replay_file.hpp"
#include "replay/speaker.hpp"

namespace roverd {
namespace {

using base::Code;
using base::Result;

/// Parts of one run begin within this: a receiver that was plugged in late.
constexpr base::Duration kOneRun = std::chrono::hours(1);

/// Begin is known once an item is loaded.
template <class File>
std::optional<base::Duration> begin_of(File& file) {
  static_cast<void>(file.advance());
  return file.begin();
}

const char* kind_in_words(const std::string& driver) {
  if (driver == "bunker") return "a CAN bus";
  if (driver == "gnss" || driver == "gpsd") return "a receiver";
  if (driver == "mti") return "an inertial unit";
  if (driver == "ntrip") return "corrections";
  return driver == "bumper" ? "a bumper" : "a drive link";
}

}  // namespace

Result<RecordingLook> look_into(const std::string& path, const link::ReplayOptions& how) {
  link::FrameFile frames(path, [](const base::CanFrame&, base::Time) {});
  if (frames.open()) return RecordingLook{"bunker", begin_of(frames)};
  link::ByteFile bytes(path, how, [](base::Bytes, base::Time) {});
  if (const auto opened = bytes.open(); !opened) {
    return base::fail(opened.error().code, "--replay: " + opened.error().detail);
  }
  if (!bytes.tells_time()) {
    return base::fail(Code::Invalid, "--replay: " + path +
                                         " is no recording: neither of roverd, nor a candump log, "
                                         "nor NMEA sentences");
  }
  return RecordingLook{speaker_of(path, how), begin_of(bytes)};
}

Result<Replays> read_replays(const std::vector<std::string>& files, double speed) {
  Replays out;
  out.how.speed = speed;
  out.how.line_clock = gnss::time_of_day_s;
  std::optional<base::Duration> first;
  std::optional<base::Duration> last;
  for (const std::string& path : files) {
    auto seen = look_into(path, out.how);
    if (!seen) return tl::unexpected(seen.error());
    if (seen->driver.empty()) continue;
    const auto same = std::ranges::find_if(out.file_of, [&](const auto& other) {
      return kind_in_words(other.first) == std::string_view(kind_in_words(seen->driver));
    });
    const auto at =
        same == out.file_of.end() ? out.file_of.emplace(seen->driver, path).first : same;
    if (same != out.file_of.end()) {
      return base::fail(Code::Invalid, "--replay: " + at->second + " and " + path +
                                           " are both recordings of " +
                                           kind_in_words(seen->driver));
    }
    if (!seen->begin) continue;
    first = std::min(first.value_or(*seen->begin), *seen->begin);
    last = std::max(last.value_or(*seen->begin), *seen->begin);
  }
  if (!files.empty() &&
      (out.file_of.empty() || (out.file_of.size() == 1 && out.file_of.contains("ntrip")))) {
    return base::fail(Code::Invalid, "--replay: " + files.front() +
                                         " holds nothing that a robot could be driven by");
  }
  if (out.file_of.size() < 2) return out;
  if (speed <= 0.0) {
    return base::fail(
        Code::Invalid,
        "--replay-speed 0 with several recordings: without a pace they would not stay "
        "in step");
  }
  if (first && *last - *first > kOneRun) {
    return base::fail(Code::Invalid,
                      "--replay: the recordings begin more than an hour apart: they are not of one "
                      "run");
  }
  out.how.together = std::make_shared<link::ReplayTogether>();
  out.how.together->begin = first.value_or(base::Duration::zero());
  return out;
}

}  // namespace roverd
