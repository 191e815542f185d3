#include "services/teach.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/time.hpp"

namespace roverd::services {
namespace {

using base::Code;
using base::Result;
using base::Severity;
using State = TeachIn::State;

constexpr const char* kTeachAuthor = "teach-in";
/// A pose older than this is not where the robot is.
constexpr double kFresh_s = 0.5;

std::string usual_name(base::WallTime wall) {
  constexpr std::size_t kDay = 10;
  constexpr std::size_t kMinute = 16;
  std::string text = base::to_rfc3339(wall).substr(0, kMinute);
  if (text.size() > kDay) text[kDay] = ' ';
  return "Taught " + text;
}

/// Empty: the position may be recorded.
std::string trouble_with(const base::Snapshot& s, double sigma_max_m) {
  if (!s.pose) return "the position is not known";
  if (base::seconds(s.now - s.pose->stamp) > kFresh_s) return "the position is stale";
  if (s.pose->horizontal_sigma_m <= sigma_max_m) return {};
  const auto cm = [](double m) { return std::to_string(std::lround(m * 100.0)) + " cm"; };
  return "the position is uncertain by " + cm(s.pose->horizontal_sigma_m) + ", at most " +
         cm(sigma_max_m) + " are recorded";
}

}  // namespace

const char* to_string(TeachState state) noexcept {
  switch (state) {
    case State::Loading:
      return "loading";
    case State::Idle:
      return "idle";
    case State::Recording:
      return "recording";
    case State::Paused:
      return "paused";
    case State::Interrupted:
      return "interrupted";
  }
  return "";
}

TeachIn::TeachIn(store::Store& store) : store_(store) {
  const std::weak_ptr<TeachIn*> self = self_;
  store_.read_teach([self](Result<std::optional<store::TeachRecord>> found) {
    const auto alive = self.lock();
    if (!alive) return;
    TeachIn& t = **alive;
    if (!found) {
      return t.event(Severity::Error, "teach_unreadable", std::move(found.error().detail));
    }
    t.state_ = State::Idle;
    if (!*found) return;
    t.record_ = std::move(**found);
    t.saved_ = t.record_.points.size();
    t.length_m_ = mission::taught_length_m(t.record_.points);
    t.gaps_ = static_cast<int>(std::count_if(t.record_.points.begin(), t.record_.points.end(),
                                             [](const auto& p) { return p.gap; }));
    t.state_ = State::Interrupted;
    t.event(Severity::Warning, "teach_interrupted",
            "the recording \"" + t.record_.name + "\" was interrupted after " +
                std::to_string(t.saved_) + " points: resume, stop or discard it");
  });
}

TeachIn::~TeachIn() = default;

void TeachIn::event(Severity level, const char* kind, std::string detail) {
  if (tell) tell({base::wall_now(), level, kind, std::move(detail)});
}

Result<void> TeachIn::allow(const char* what, std::initializer_list<State> from) const {
  if (state_ == State::Loading) return base::fail(Code::Unavailable, "the store has not answered");
  if (busy_) return base::fail(Code::Conflict, "the recording is being saved");
  if (std::find(from.begin(), from.end(), state_) != from.end()) return {};
  const std::string is = state_ == State::Idle
                             ? "nothing is being recorded"
                             : "a recording is there, " + std::string(to_string(state_));
  return base::fail(Code::Conflict, std::string("cannot ") + what + ": " + is);
}

void TeachIn::forget() {
  state_ = State::Idle;
  record_ = {};
  sampler_.reset();
  saved_ = sending_ = 0;
  save_failed_ = false;
  length_m_ = 0.0;
  gaps_ = 0;
  waiting_.clear();
}

void TeachIn::start(const mission::TeachSettings& settings, std::string name, Done done) {
  if (auto fine = allow("start", {State::Idle}); !fine) return done(fine);
  store::TeachRecord record;
  record.started = base::wall_now();
  record.name = name.empty() ? usual_name(record.started) : std::move(name);
  record.settings = settings;
  busy_ = true;
  const std::weak_ptr<TeachIn*> self = self_;
  store_.begin_teach(record, [self, record, done = std::move(done)](Result<void> result) {
    const auto alive = self.lock();
    if (!alive) return;
    TeachIn& t = **alive;
    t.busy_ = false;
    if (result) {
      t.record_ = record;
      t.sampler_.emplace(record.settings);
      t.state_ = State::Recording;
      t.event(Severity::Info, "teach_started", "recording \"" + record.name + "\"");
    }
    done(std::move(result));
  });
}

void TeachIn::pause(Done done) {
  if (auto fine = allow("pause", {State::Recording}); !fine) return done(fine);
  take(sampler_->finish());
  if (!record_.points.empty()) sampler_->interrupt();  // else the first point is yet to come
  state_ = State::Paused;
  waiting_.clear();
  event(Severity::Info, "teach_paused",
        "after " + std::to_string(record_.points.size()) + " points");
  done({});
}

void TeachIn::resume(Done done) {
  if (auto fine = allow("resume", {State::Paused, State::Interrupted}); !fine) return done(fine);
  if (!sampler_) {
    sampler_.emplace(record_.settings);
    if (!record_.points.empty()) sampler_->interrupt();
  }
  state_ = State::Recording;
  event(Severity::Info, "teach_resumed", "recording \"" + record_.name + "\"");
  done({});
}

void TeachIn::discard(Done done) {
  if (auto fine = allow("discard", {State::Recording, State::Paused, State::Interrupted}); !fine) {
    return done(fine);
  }
  busy_ = true;
  const std::weak_ptr<TeachIn*> self = self_;
  store_.discard_teach([self, done = std::move(done)](Result<void> result) {
    const auto alive = self.lock();
    if (!alive) return;
    TeachIn& t = **alive;
    t.busy_ = false;
    if (result) {
      t.event(Severity::Info, "teach_discarded",
              std::to_string(t.record_.points.size()) + " points of \"" + t.record_.name + "\"");
      t.forget();
    }
    done(std::move(result));
  });
}

void TeachIn::stop(std::string name, std::optional<double> tolerance_m, Saved saved) {
  if (auto fine = allow("stop", {State::Recording, State::Paused, State::Interrupted}); !fine) {
    return saved(tl::unexpected(fine.error()));
  }
  if (sampler_ && state_ == State::Recording) take(sampler_->finish());
  auto plan = mission::mission_of(record_.points, name.empty() ? record_.name : name,
                                  tolerance_m.value_or(record_.settings.tolerance_m));
  if (!plan) return saved(tl::unexpected(std::move(plan.error())));
  busy_ = true;
  const std::weak_ptr<TeachIn*> self = self_;
  const std::string what = "recorded from " + std::to_string(record_.points.size()) + " points";
  store_.finish_teach(std::move(*plan), {kTeachAuthor, what},
                      [self, saved = std::move(saved)](Result<store::StoredMission> stored) {
                        const auto alive = self.lock();
                        if (!alive) return;
                        TeachIn& t = **alive;
                        t.busy_ = false;
                        if (stored) {
                          t.forget();
                          t.event(Severity::Info, "teach_saved", "\"" + stored->plan.name + "\"");
                          if (t.announce) t.announce(*stored);
                        }
                        saved(std::move(stored));
                      });
}

void TeachIn::wish(robot::TeachWish wish) {
  const auto told = [this](const char* what) {
    return [this, what](Result<void> result) {
      if (result) return;
      event(Severity::Warning, "teach_refused", std::string(what) + ": " + result.error().detail);
    };
  };
  switch (wish) {
    case robot::TeachWish::Start:
      if (state_ == State::Paused || state_ == State::Interrupted) return resume(told("resume"));
      return start({}, {}, told("start"));
    case robot::TeachWish::Pause:
      return pause(told("pause"));
    case robot::TeachWish::Stop:
      return stop({}, {}, [told](Result<store::StoredMission> stored) {
        told("stop")(stored ? Result<void>{} : tl::unexpected(stored.error()));
      });
    case robot::TeachWish::Discard:
      return discard(told("discard"));
  }
}

void TeachIn::sample(const base::Snapshot& s) {
  if (state_ != State::Recording || busy_) return;
  waiting_ = trouble_with(s, record_.settings.sigma_max_m);
  mission::TeachSample sample;
  sample.trusted = waiting_.empty();
  if (s.pose) {
    sample.stamp = s.pose->stamp;
    sample.at = s.pose->global;
    sample.yaw_rad = s.pose->yaw_rad;
    sample.speed_mps = s.pose->speed_mps.value_or(0.0);
  }
  take(sampler_->take(sample));
  if (record_.points.size() < mission::kMaxTaughtPoints) return;
  pause([](const Result<void>&) {});
  event(Severity::Warning, "teach_full", "the recording is as long as it can be: stop it");
}

void TeachIn::take(const std::vector<mission::TaughtPoint>& points) {
  for (const mission::TaughtPoint& p : points) {
    if (p.gap) {
      ++gaps_;
    } else if (!record_.points.empty()) {
      length_m_ += base::distance_bearing(record_.points.back().at, p.at).distance_m;
    }
    record_.points.push_back(p);
  }
}

void TeachIn::save() {
  if (busy_ || sending_ > 0 || saved_ >= record_.points.size()) return;
  const auto first = record_.points.begin() + static_cast<std::ptrdiff_t>(saved_);
  std::vector<mission::TaughtPoint> points(first, record_.points.end());
  sending_ = points.size();
  const std::weak_ptr<TeachIn*> self = self_;
  store_.add_teach_points(
      std::move(points), [self, started = record_.started](Result<void> result) {
        const auto alive = self.lock();
        if (!alive || (*alive)->record_.started != started) return;  // it was stopped meanwhile
        TeachIn& t = **alive;
        const std::size_t sent = std::exchange(t.sending_, 0);
        if (result) {
          t.saved_ += sent;
          t.save_failed_ = false;
        } else if (!std::exchange(t.save_failed_, true)) {
          t.event(Severity::Error, "teach_not_saved",
                  "the recording goes on in memory alone: " + result.error().detail);
        }
      });
}

TeachView TeachIn::view() const {
  return {.state = state_,
          .points = record_.points.size(),
          .length_m = length_m_,
          .name = record_.name,
          .started = record_.started,
          .gaps = gaps_,
          .unsaved_points = record_.points.size() - saved_,
          .waiting = waiting_,
          .settings = record_.settings};
}

}  // namespace roverd::services
