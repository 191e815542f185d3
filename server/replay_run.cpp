#include "replay_run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

#include "bunker/driver.hpp"
#include "gnss/driver.hpp"
#include "gnss/nmea.hpp"
#include "link/memory.hpp"
#include "link/record_file.hpp"
#include "link/replay_file.hpp"
#include "mti/driver.hpp"
#include "nav/estimate/estimator.hpp"
#include "replays.hpp"

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

using Tell = std::function<void(const base::Measurement&)>;

/// One recording with the driver that hears it.
class Part {
 public:
  virtual ~Part() = default;
  Part() = default;
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  /// Opens the first file and loads its first item.
  Result<void> open(std::vector<std::string> chain) {
    chain_ = std::move(chain);
    return open_next();
  }
  std::optional<base::Duration> begin() const { return file_ ? file_->begin() : std::nullopt; }
  /// @param run_begin UTC since 1970; empty: no recording has dates.
  void align(std::optional<base::Duration> run_begin) { run_begin_ = run_begin; }
  /// When the loaded item is due, since the run's beginning; empty: there is no more.
  std::optional<base::Duration> due() const {
    if (!at_) return {};
    return std::max(last_, *at_ + offset());
  }
  Result<void> emit(Time now) {
    last_ = *due();
    clock_ = now;
    file_->emit(now);
    return load();
  }
  virtual void start(Time now) = 0;
  virtual void tick(Time now) = 0;
  virtual base::DriverStatus status(Time now) const = 0;

 protected:
  virtual Result<std::unique_ptr<link::ReplayFile>> make_file(const std::string& path) = 0;
  Time clock_{};

 private:
  base::Duration offset() const {
    const auto begin = file_->begin();
    // Without dates a file begins with the run, a later one where the one before ended.
    if (!begin || !run_begin_) return before_;
    return *begin - *run_begin_;
  }
  Result<void> open_next() {
    before_ = last_;
    auto made = make_file(chain_[next_++]);
    if (!made) return tl::unexpected(made.error());
    file_ = std::move(*made);
    return load();
  }
  Result<void> load() {
    auto next = file_->advance();
    if (!next) return tl::unexpected(next.error());
    at_ = *next;
    return at_ || next_ == chain_.size() ? Result<void>{} : open_next();
  }

  std::vector<std::string> chain_;
  std::size_t next_ = 0;
  std::unique_ptr<link::ReplayFile> file_;
  std::optional<base::Duration> at_;  ///< of the loaded item, since its file's beginning
  std::optional<base::Duration> run_begin_;
  base::Duration last_{};
  base::Duration before_{};
};

class BusPart final : public Part {
 public:
  BusPart(const bunker::Params& params, const Tell& tell)
      : wire_(link::memory_frame_pair()),
        driver_(
            "bunker", params,
            [this] { return Result<std::unique_ptr<link::FrameLink>>(std::move(wire_.a)); }, tell) {
    wire_.b->set_immediate([this] { return clock_; });
    static_cast<void>(wire_.b->open());
  }
  void start(Time now) override { driver_.start(now); }
  void tick(Time now) override { driver_.tick(now); }
  base::DriverStatus status(Time now) const override { return driver_.status(now); }

 private:
  Result<std::unique_ptr<link::ReplayFile>> make_file(const std::string& path) override {
    auto file = std::make_unique<link::FrameFile>(
        path, [this](const base::CanFrame& f, Time) { wire_.b->send(f); });
    if (const auto opened = file->open(); !opened) return tl::unexpected(opened.error());
    return Result<std::unique_ptr<link::ReplayFile>>(std::move(file));
  }
  link::MemoryFramePair wire_;
  bunker::Driver driver_;
};

template <class Driver, class Params>
class BytePart final : public Part {
 public:
  BytePart(const char* name, const Params& params, const Tell& tell)
      : wire_(link::memory_byte_pair()),
        driver_(
            name, params,
            [this] { return Result<std::unique_ptr<link::ByteLink>>(std::move(wire_.a)); }, tell) {
    wire_.b->set_immediate([this] { return clock_; });
    static_cast<void>(wire_.b->open());
  }
  void start(Time now) override { driver_.start(now); }
  void tick(Time now) override { driver_.tick(now); }
  base::DriverStatus status(Time now) const override { return driver_.status(now); }

 private:
  Result<std::unique_ptr<link::ReplayFile>> make_file(const std::string& path) override {
    link::ReplayOptions how;
    how.line_clock = gnss::time_of_day_s;
    auto file = std::make_unique<link::ByteFile>(
        path, how, [this](base::Bytes b, Time) { wire_.b->write(b); });
    if (const auto opened = file->open(); !opened) return tl::unexpected(opened.error());
    return Result<std::unique_ptr<link::ReplayFile>>(std::move(file));
  }
  link::MemoryBytePair wire_;
  Driver driver_;
};

/// A hole in a recording is no reason to open it again, and nobody there answers.
std::unique_ptr<Part> part_for(const std::string& driver, const Settings& s, const Tell& tell) {
  if (driver == "bunker") {
    bunker::Params p = s.bunker.params;
    p.silent_reopen_s = 0.0;
    return std::make_unique<BusPart>(p, tell);
  }
  if (driver == "mti") {
    mti::Params p = s.mti.params;
    p.silent_reopen_s = 0.0;
    p.configure = false;
    return std::make_unique<BytePart<mti::Driver, mti::Params>>("mti", p, tell);
  }
  gnss::Params p = s.gnss.params;
  p.silent_reopen_s = 0.0;
  p.ubx_configure = false;
  return std::make_unique<BytePart<gnss::Driver, gnss::Params>>("gnss", p, tell);
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
    while (Part* next = earliest()) {
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
      const auto [at, is_new] = chains.emplace(seen->driver, chain_of(file));
      if (!is_new) {
        return base::fail(Code::Invalid, at->second.front() + " and " + file +
                                             " are both recordings of the driver " + at->first);
      }
    }
    std::optional<base::Duration> first;
    std::optional<base::Duration> last;
    for (auto& [driver, chain] : chains) {
      report_.files.insert(report_.files.end(), chain.begin(), chain.end());
      auto part = part_for(driver, settings_, [this](const base::Measurement& m) {
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
  Part* earliest() const {
    Part* out = nullptr;
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
  std::map<std::string, std::unique_ptr<Part>> parts_;
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
