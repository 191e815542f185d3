#include "replay/run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

#include "gnss/nmea.hpp"
#include "link/record_file.hpp"
#include "nav/estimate/estimator.hpp"
#include "replay/parts.hpp"
#include "replay/replays.hpp"

namespace roverd {
namespace {

using base::Code;
using base::Result;
using base::Time;

constexpr base::Duration kTick = std::chrono::milliseconds(20);
/// The drivers' time begins here: a stamp of zero means nothing.
constexpr Time kBegin{std::chrono::seconds(100)};
/// After the last item, for epochs that wait for more.
constexpr base::Duration kAfter = std::chrono::milliseconds(500);
/// Parts of one run begin within this.
constexpr base::Duration kSameRun = std::chrono::hours(1);

/// X.log, X.002.log, X.003.log … as far as they are there.
std::vector<std::string> chain_of(const std::string& first) {
  std::vector<std::string> out{first};
  std::error_code ec;
  for (int n = 2; n < 1000; ++n) {
    std::string next = link::numbered_file(first, n);
    if (!std::filesystem::is_regular_file(next, ec)) break;
    out.push_back(std::move(next));
  }
  return out;
}

/// Estimator and what is counted of its work.
class Judge {
 public:
  explicit Judge(const nav::EstimateParams& params) : estimator_(params) {}

  void take(const base::Measurement& m, Time now) {
    if (const auto* fix = std::get_if<base::GnssFix>(&m)) fix_ = fix->fix;
    const char* name = name_of(m);
    estimator_.take(m, now);
    if (name == nullptr) return;
    ReplayInput& input = inputs_[name];
    ++input.taken;
    const base::EstimatorHealth health = estimator_.health();
    const base::InputHealth& after = input_of(health, name);
    base::InputHealth& before = before_[name];
    input.rejected += after.rejected - before.rejected;
    const bool compared = after.rejected == before.rejected && after.innovation &&
                          (!before.innovation || before.innovation->nis != after.innovation->nis ||
                           before.innovation->size != after.innovation->size);
    if (compared) {
      ++input.used;
      input.nis_sum += after.innovation->nis;
      input.square_sum += after.innovation->size * after.innovation->size;
      input.largest = std::max(input.largest, std::abs(after.innovation->size));
    }
    before = after;
  }
  std::optional<base::Pose> advance(Time now) {
    estimator_.advance(now);
    return estimator_.pose(now);
  }
  base::FixType fix() const noexcept { return fix_; }
  void finish(ReplayReport& report) const {
    report.inputs = {inputs_.begin(), inputs_.end()};
    report.health = estimator_.health();
  }

 private:
  static const char* name_of(const base::Measurement& m) noexcept {
    if (std::holds_alternative<base::GnssFix>(m)) return "position";
    if (std::holds_alternative<base::GnssVelocity>(m)) return "velocity";
    if (const auto* heading = std::get_if<base::Heading>(&m)) {
      return heading->source == base::HeadingSource::Compass ? "compass" : "heading";
    }
    if (std::holds_alternative<base::WheelTravel>(m)) return "odometry";
    return std::holds_alternative<base::Inertial>(m) ? "inertial" : nullptr;
  }
  static const base::InputHealth& input_of(const base::EstimatorHealth& h,
                                           std::string_view name) noexcept {
    if (name == "position") return h.position;
    if (name == "velocity") return h.velocity;
    if (name == "compass") return h.compass;
    if (name == "heading") return h.heading;
    return name == "odometry" ? h.odometry : h.inertial;
  }

  nav::Estimator estimator_;
  base::FixType fix_ = base::FixType::None;
  std::map<std::string_view, ReplayInput> inputs_;
  std::map<std::string_view, base::InputHealth> before_;
};

class Run {
 public:
  Run(const ReplayPlan& plan, const Settings& settings,
      const std::function<void(const ReplayPose&)>& on_pose)
      : plan_(plan), settings_(settings), on_pose_(on_pose), judge_(settings.robot.estimate) {}

  Result<ReplayReport> go() {
    if (auto opened = open(); !opened) return tl::unexpected(opened.error());
    for (const auto& [name, part] : parts_) part->start(kBegin);
    Time tick = kBegin;
    base::Duration end{};
    while (ReplayPart* next = earliest()) {
      end = *next->due();
      while (tick + kTick <= kBegin + end) step(tick += kTick);
      if (auto played = next->emit(kBegin + end); !played) return tl::unexpected(played.error());
      ++report_.items;
    }
    ended_ = true;
    while (tick < kBegin + end + kAfter) step(tick += kTick);
    report_.duration_s = base::seconds(end);
    judge_.finish(report_);
    for (const auto& [name, part] : parts_) report_.drivers.push_back(part->status(tick));
    return std::move(report_);
  }

 private:
  /// A file that another one leads to need not be named, but may be.
  Result<void> open() {
    link::ReplayOptions how;
    how.line_clock = gnss::time_of_day_s;
    std::map<std::string, std::vector<std::string>> chains;
    for (const std::string& file : plan_.files) {
      const bool known = std::ranges::any_of(chains, [&](const auto& chain) {
        return std::ranges::find(chain.second, file) != chain.second.end();
      });
      if (known) continue;
      auto seen = look_into(file, how);
      if (!seen) return tl::unexpected(seen.error());
      if (seen->driver.empty()) continue;  // a device that never said anything
      const auto [at, is_new] = chains.emplace(seen->driver, chain_of(file));
      if (!is_new) {
        return base::fail(Code::Invalid, at->second.front() + " and " + file +
                                             " are both recordings of the driver " + at->first);
      }
    }
    if (chains.empty()) return base::fail(Code::Invalid, "the recordings are empty");
    if (chains.contains("gnss") && chains.contains("gpsd")) {
      return base::fail(Code::Invalid, chains["gnss"].front() + " and " + chains["gpsd"].front() +
                                           " are both recordings of a receiver");
    }
    std::optional<base::Duration> first;
    std::optional<base::Duration> last;
    for (auto& [driver, chain] : chains) {
      report_.files.insert(report_.files.end(), chain.begin(), chain.end());
      auto part = replay_part(driver, settings_, [this](const base::Measurement& m) {
        if (!std::holds_alternative<base::DriverStatus>(m)) heard_.push_back(m);
      });
      if (auto opened = part->open(std::move(chain)); !opened) {
        return tl::unexpected(opened.error());
      }
      if (const auto begin = part->begin()) {
        first = std::min(first.value_or(*begin), *begin);
        last = std::max(last.value_or(*begin), *begin);
      }
      parts_.emplace(driver, std::move(part));
    }
    if (first && *last - *first > kSameRun) {
      return base::fail(Code::Invalid,
                        "the recordings begin more than an hour apart: they are not of one run");
    }
    begin_ = first;
    for (const auto& [name, part] : parts_) part->align(first);
    return {};
  }

  /// Equal times: by the driver's name, so that a run is always the same.
  ReplayPart* earliest() const {
    ReplayPart* out = nullptr;
    for (const auto& [name, part] : parts_) {
      const auto due = part->due();
      if (due && (out == nullptr || *due < *out->due())) out = part.get();
    }
    return out;
  }

  void step(Time now) {
    for (const auto& [name, part] : parts_) part->tick(now);
    for (const base::Measurement& m : heard_) judge_.take(m, now);
    heard_.clear();
    const auto pose = judge_.advance(now);
    if (!pose || ended_) return;  // what the estimator would guess after the end is no track
    ++report_.poses;
    if (last_) report_.way_m += base::distance_m(*last_, pose->at);
    last_ = pose->at;
    if (told_ && base::seconds(now - *told_) < plan_.every_s - 1e-9) return;
    told_ = now;
    ReplayPose out{base::seconds(now - kBegin), {}, *pose, judge_.fix()};
    if (begin_) out.wall = base::WallTime{*begin_ + (now - kBegin)};
    on_pose_(out);
  }

  const ReplayPlan& plan_;
  const Settings& settings_;
  const std::function<void(const ReplayPose&)>& on_pose_;
  Judge judge_;
  std::vector<base::Measurement> heard_;
  std::map<std::string, std::unique_ptr<ReplayPart>> parts_;
  std::optional<base::Duration> begin_;
  bool ended_ = false;
  std::optional<base::EnuPoint> last_;
  std::optional<Time> told_;
  ReplayReport report_;
};

}  // namespace

Result<ReplayReport> run_replay(const ReplayPlan& plan, const Settings& settings,
                                const std::function<void(const ReplayPose&)>& on_pose) {
  return Run(plan, settings, on_pose).go();
}

}  // namespace roverd
