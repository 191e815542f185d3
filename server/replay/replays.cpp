#include "replay/replays.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "gnss/stream_clock.hpp"
#include "link/replay_file.hpp"
#include "mti/stream_clock.hpp"
#include "replay/sensors.hpp"
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

/// @param driver one of them, or the name of a sensor.
std::string kind_in_words(const std::string& driver) {
  constexpr std::array<std::string_view, 5> kDrives{"ackermann", "bunker", "bumper", "ratio",
                                                    "twist"};
  const bool base = std::ranges::find(kDrives, driver) != kDrives.end();
  if (driver == "bunker") return "a CAN bus";
  if (driver == "gnss" || driver == "gpsd") return "a receiver";
  if (driver == "mti") return "an inertial unit";
  if (driver == "ntrip") return "corrections";
  if (!base) return "sensor " + driver;
  return driver == "bumper" ? "a bumper" : "a drive link";
}

/// From the kind of a sensor to its name. None of that kind: the recording is left out, and its
/// driver empty.
Result<void> settle_sensor(Recording& seen, const Sensors& sensors, RunFiles& run) {
  if (!is_sensor_kind(seen.driver)) return {};
  auto name = sensor_of_recording(seen.file, seen.driver, sensors);
  if (!name) return tl::unexpected(name.error());
  if (name->empty()) {
    run.left_out.push_back(seen.file + " is of a sensor of the kind " + seen.driver +
                           ", and none is configured: left out");
  }
  seen.driver = std::move(*name);
  return {};
}

/// Listens with both until it is clear who speaks: from the first part of the stream on, the clock
/// of whom more messages tell a time.
class DeviceClock {
 public:
  void hear(base::Bytes bytes, const base::OnStreamMark& on) {
    if (chosen_) return chosen_(bytes, on);
    std::vector<base::StreamMark> unit;
    std::vector<base::StreamMark> receiver;
    base::StreamClock of_unit = mti::stream_clock();
    base::StreamClock of_receiver = gnss::stream_clock();
    of_unit(bytes, [&](const base::StreamMark& mark) { unit.push_back(mark); });
    of_receiver(bytes, [&](const base::StreamMark& mark) { receiver.push_back(mark); });
    const auto timed = [](const std::vector<base::StreamMark>& marks) {
      return std::ranges::count_if(marks, [](const auto& mark) { return mark.time.has_value(); });
    };
    const bool is_unit = timed(unit) > timed(receiver);
    chosen_ = is_unit ? std::move(of_unit) : std::move(of_receiver);
    for (const base::StreamMark& mark : is_unit ? unit : receiver) on(mark);
  }

 private:
  base::StreamClock chosen_;
};

/// "--replay: " is the option of the one command and the argument of the other.
base::Error told(const base::Error& e) {
  return {e.code, "--replay: " + e.detail, e.fields};
}

}  // namespace

base::StreamClock device_clock() {
  return [clock = std::make_shared<DeviceClock>()](
             base::Bytes bytes, const base::OnStreamMark& on) { clock->hear(bytes, on); };
}

Result<Recording> look_into(const std::string& path) {
  link::ReplayOptions how;
  how.make_clock = device_clock;
  link::FrameFile frames(path, [](const base::CanFrame&, base::Time) {});
  if (frames.open()) return Recording{path, "bunker", begin_of(frames)};
  link::ByteFile bytes(path, how, [](base::Bytes, base::Time) {});
  if (const auto opened = bytes.open(); !opened) return tl::unexpected(opened.error());
  if (bytes.pace() == link::ByteFile::Pace::Rated) {
    return base::fail(Code::Invalid,
                      path +
                          " is no recording: neither of roverd, nor a candump log, nor bytes of a "
                          "receiver or an inertial unit that tell their time");
  }
  return Recording{path, speaker_of(path, how), begin_of(bytes),
                   bytes.pace() == link::ByteFile::Pace::Clocked};
}

Result<RunFiles> tell_apart(const std::vector<std::string>& files, const Sensors& sensors) {
  RunFiles out;
  std::set<std::string> known;
  std::optional<base::Duration> last;
  for (const std::string& path : files) {
    if (known.contains(path)) continue;
    auto seen = look_into(path);
    if (!seen) return tl::unexpected(seen.error());
    for (std::string& part : link::ReplayFile::parts_of(path)) known.insert(std::move(part));
    if (seen->driver.empty()) continue;  // a device that never said anything
    if (auto heard = settle_sensor(*seen, sensors, out); !heard) {
      return tl::unexpected(heard.error());
    }
    if (seen->driver.empty()) continue;
    const std::string kind = kind_in_words(seen->driver);
    const auto same = std::ranges::find_if(
        out.of, [&](const auto& other) { return kind == kind_in_words(other.first); });
    if (same != out.of.end()) {
      return base::fail(Code::Invalid,
                        same->second.file + " and " + path + " are both recordings of " + kind);
    }
    if (seen->begin) {
      out.begin = std::min(out.begin.value_or(*seen->begin), *seen->begin);
      last = std::max(last.value_or(*seen->begin), *seen->begin);
    }
    out.of.emplace(seen->driver, std::move(*seen));
  }
  if (out.begin && *last - *out.begin > kOneRun) {
    return base::fail(Code::Invalid,
                      "the recordings begin more than an hour apart: they are not of one run");
  }
  return out;
}

Result<Replays> read_replays(const std::vector<std::string>& files, double speed,
                             const Sensors& sensors) {
  Replays out;
  out.how.speed = speed;
  out.how.make_clock = device_clock;
  if (files.empty()) return out;
  const auto run = tell_apart(files, sensors);
  if (!run) return tl::unexpected(told(run.error()));
  out.remarks = run->left_out;
  if (run->of.empty() || (run->of.size() == 1 && run->of.contains("ntrip"))) {
    return base::fail(Code::Invalid, "--replay: " + files.front() +
                                         " holds nothing that a robot could be driven by");
  }
  for (const auto& [driver, recording] : run->of) {
    out.file_of.emplace(driver, recording.file);
    if (recording.by_device) {
      out.remarks.push_back(recording.file +
                            " has no time stamps: it is paced by the time that the device told");
    }
  }
  if (out.file_of.size() < 2) return out;
  if (speed <= 0.0) {
    return base::fail(
        Code::Invalid,
        "--replay-speed 0 with several recordings: without a pace they would not stay "
        "in step");
  }
  out.how.together = std::make_shared<link::ReplayTogether>();
  out.how.together->begin = run->begin.value_or(base::Duration::zero());
  return out;
}

}  // namespace roverd
