#include "replay/run.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "link/replay_file.hpp"
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
  Result<void> open() {
    const auto run = tell_apart(plan_.files, settings_.sensors);
    if (!run) return tl::unexpected(run.error());
    if (run->of.empty()) return base::fail(Code::Invalid, "the recordings are empty");
    begin_ = run->begin;
    report_.left_out = run->left_out;
    for (const auto& [driver, recording] : run->of) {
      auto parts = link::ReplayFile::parts_of(recording.file);
      report_.files.insert(report_.files.end(), parts.begin(), parts.end());
      if (recording.by_device) report_.by_device.push_back(recording.file);
      auto part = replay_part(
          driver, settings_,
          [this](const base::Measurement& m) {
            if (!std::holds_alternative<base::DriverStatus>(m)) heard_.push_back(m);
          },
          [this](const std::shared_ptr<const base::Sight>& sight) {
            ++report_.sights[sight->sensor];
            if (plan_.on_sight) plan_.on_sight(sight);
          });
      if (auto opened = part->open(recording.file); !opened) return opened;
      part->align(begin_);
      parts_.emplace(driver, std::move(part));
    }
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
