#include "app/keep_out.hpp"
#include "app/station_impl.hpp"

namespace roverd {

namespace {
constexpr base::Duration kKeepLearned = std::chrono::minutes(1);
constexpr base::Duration kLookAtHost = std::chrono::seconds(1);
constexpr base::Duration kTidyRecordings = std::chrono::minutes(1);
constexpr base::Duration kLookAtNames = std::chrono::seconds(5);

bool anything(const nav::Learned& l) {
  return l.odometry_scale || l.gyro_bias_radps || l.delay_s || l.braking_mps2 ||
         l.acceleration_mps2 || l.yaw_scale || l.pull_1pm || l.pivot_m || l.forgotten;
}

}  // namespace

void Station::Impl::recall(const Settings& settings, const Options& options) {
  if (!options.replays.empty()) return;
  learned_file = std::filesystem::path(options.data) / "learned.json";
  learned_by = learner(settings);
  const nav::Learned known = read_learned(learned_file, learned_by, base::wall_now());
  robot.recall(known);
  if (!anything(known)) return;
  const auto text = [](const std::optional<nav::LearnedValue>& v) {
    return v ? std::to_string(v->value) : std::string("not known");
  };
  base::log(base::Level::Info, "main", "learned before",
            {{"odometry_scale", text(known.odometry_scale)},
             {"gyro_bias_radps", text(known.gyro_bias_radps)},
             {"delay_s", text(known.delay_s)},
             {"braking_mps2", text(known.braking_mps2)}});
}

/// A disk may pause: on a worker's thread, or, at the end, after all others.
void Station::Impl::keep_learned() {
  const auto learned = robot.learned();
  if (learned_file.empty() || !learned) return;
  if (!anything(*learned)) return;
  const auto kept = write_learned(learned_file, *learned, learned_by, base::wall_now());
  if (!kept) {
    base::log(base::Level::Warning, "main", "what was learned is not kept",
              {{"reason", kept.error().detail}});
  }
}

void Station::Impl::keep_learned_soon() {
  learned_timer.expires_after(kKeepLearned);
  learned_timer.async_wait([this](const boost::system::error_code& ec) {
    if (ec) return;
    workers.must_run(net::Lane::Small, [this] { keep_learned(); }, {});
    keep_learned_soon();
  });
}

/// At once and then every minute, each when the one before is done: a disk may take its time.
void Station::Impl::tidy_recordings() {
  if (!tidier) return;
  const auto events = std::make_shared<std::vector<base::Event>>();
  workers.must_run(
      net::Lane::Large, [tidier = tidier, events] { *events = tidier->tidy(base::wall_now()); },
      [this, events] {
        for (base::Event& event : *events) api->on_event(std::move(event));
        tidy_timer.expires_after(kTidyRecordings);
        tidy_timer.async_wait([this](const boost::system::error_code& ec) {
          if (!ec) tidy_recordings();
        });
      });
}

/// A folder that was removed holds no lock any more: the link is what a second one would drive
/// over.
void Station::Impl::watch_host() {
  refill_memory_reserve();
  const base::Time now = base::steady_now();
  if (const auto snapshot = robot.snapshot()) lateness_watch.take(snapshot->loop, now);
  auto found = host_problems({.now = now,
                              .wall = base::wall_now(),
                              .storage = store->storage(),
                              .real_time = loop->real_time(),
                              .memory_locked = memory_locked,
                              .lateness_s = lateness_watch.p999_s(),
                              .unannounced = presence->unannounced()});
  if (const std::size_t n = forbidden_left_out + services->not_kept_out(); n > 0) {
    found.push_back({"forbidden_left_out",
                     "the robot does not keep out of " + std::to_string(n) +
                         " forbidden areas of the map in use: they are wider than 20 km, or have, "
                         "with the fence, more corners than can be kept out of"});
  }
  if (forbidden_unplaced > 0) {
    found.push_back({"forbidden_not_placed",
                     "the robot does not keep out of the " + std::to_string(forbidden_unplaced) +
                         " forbidden areas of the map in use: it is not known where the map lies"});
  }
  for (const base::HostProblem& problem : found) {
    const auto same = [&](const base::HostProblem& known) { return known.id == problem.id; };
    if (!problem.alarming || std::any_of(host.begin(), host.end(), same)) continue;
    robot.tell({base::wall_now(), base::Severity::Warning, problem.id, problem.detail});
  }
  host = found;
  robot.measurements().put(base::HostStatus{now, std::move(found)});
}

/// From the web thread: it must live as well as the loop.
void Station::Impl::tell_alive() {
  if (!manager.period() || !loop) return;
  const auto snapshot = robot.snapshot();
  manager.alive(snapshot ? snapshot->loop.ticks : 0);
  alive_timer.expires_after(*manager.period());
  alive_timer.async_wait([this](const boost::system::error_code& ec) {
    if (!ec) tell_alive();
  });
}

/// Web thread, every second: the forbidden areas of the map in use are kept out of as a fence is,
/// where it is known where the map lies.
void Station::Impl::watch_forbidden() {
  const auto id = shelf->in_use();
  const auto label = id ? shelf->label_of(*id) : std::nullopt;
  const bool anew = place && place->changes();  // before what it tells: that may end in between
  ForbiddenOf now;
  if (label) now = {*id, label->revision, place ? place->placed() : nullptr};
  if (now == forbidden) return;
  // It is being looked through anew: what was laid stays until it is laid again.
  if (anew && !now.placed && forbidden.placed && now.id == forbidden.id) return;
  // It has come into use this moment: where it lies is known in the next.
  if (now.id != forbidden.id && anew) return;
  const auto about = label ? shelf->find(*id) : Result<maps::About>(maps::About{});
  if (!about) return;  // it went meanwhile; in a second it is not in use any more
  forbidden = now;
  const std::string name = "forbidden in " + about->name;
  forbidden_unplaced = now.placed ? 0 : about->forbidden.size();
  if (now.placed) return keep_out(about->forbidden, told_anchor(*now.placed), name);
  forbidden_left_out = 0;
  services->keep_out({}, name);
}

/// Areas of many corners are looked through beside the web.
void Station::Impl::keep_out(std::vector<maps::Area> areas, const maps::Anchor& anchor,
                             const std::string& name) {
  const auto out = std::make_shared<std::optional<KeepOut>>();
  workers.must_run(
      net::Lane::Small,
      [out, areas = std::move(areas), anchor] { *out = keep_out_of(areas, anchor); },
      [this, out, name, of = forbidden] {
        if (!(of == forbidden)) return;  // another has come meanwhile
        if (!*out) {                     // no memory for it: in a second once more
          forbidden = {};
          return;
        }
        forbidden_left_out = (*out)->left_out;
        services->keep_out(std::move((*out)->areas), name);
      });
}

void Station::Impl::watch_host_soon() {
  host_timer.expires_after(kLookAtHost);
  host_timer.async_wait([this](const boost::system::error_code& ec) {
    if (ec || !loop) return;
    watch_host();
    watch_forbidden();
    watch_host_soon();
  });
}

/// It changes what devices must trust, or may have to be done again: not only for the log.
void Station::Impl::tell_certificate() {
  if (!front) return;
  for (const trust::Told& one : front->news()) {
    const auto level = one.alarming ? base::Level::Warning : base::Level::Info;
    const auto severity = one.alarming ? base::Severity::Warning : base::Severity::Info;
    base::log(level, "main", "certificate", {{"done", one.text}});
    robot.tell({base::wall_now(), severity, "certificate", one.text});
  }
}

/// For whoever stands before the terminal.
void Station::Impl::tell_address() {
  if (front->address() == address) return;
  address = front->address();
  std::printf("now at %s\n", address.c_str());
  std::fflush(stdout);
}

/// Names, addresses and clock change while the robot runs.
void Station::Impl::watch_names_soon() {
  if (!front) return;
  names_timer.expires_after(kLookAtNames);
  names_timer.async_wait([this](const boost::system::error_code& ec) {
    if (ec) return;
    const auto found = std::make_shared<std::optional<Result<Front::Found>>>();
    workers.must_run(
        net::Lane::Small, [this, found] { *found = front->look(); },
        [this, found] {
          if (*found) front->take(std::move(**found));
          presence->vouched_by(front->fingerprint());
          tell_certificate();
          tell_address();
          watch_names_soon();
        });
  });
}

/// The robot first: no command after this, and the base is told to stand.

}  // namespace roverd
