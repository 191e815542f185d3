#include "ntrip/driver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roverd::ntrip {

using Phase = base::DriverPhase;

namespace {

/// What looks like a frame and is not complete after this long is none.
constexpr base::Duration kStalledFrame = std::chrono::seconds(1);
/// An older fix is not where we are.
constexpr double kFixReach_s = 10.0;
constexpr std::size_t kNamedMountpoints = 20;

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string listed(const std::vector<Source>& sources) {
  std::string out;
  for (std::size_t i = 0; i < std::min(sources.size(), kNamedMountpoints); ++i) {
    out += (i > 0 ? ", " : "") + sources[i].mountpoint;
    if (!sources[i].format.empty()) out += " (" + sources[i].format + ")";
  }
  if (sources.size() > kNamedMountpoints) {
    out += " and " + std::to_string(sources.size() - kNamedMountpoints) + " more";
  }
  // A caster may send anything.
  for (char& c : out) {
    if (c < ' ' || c >= 0x7F) c = '?';
  }
  return out.empty() ? "none" : out;
}

}  // namespace

Driver::Driver(std::string name, const Params& params, std::vector<Caster> casters, Doors doors)
    : name_(std::move(name)),
      params_(params),
      casters_(std::move(casters)),
      doors_(std::move(doors)),
      turns_(casters_.size(), Turn{.not_before = {}, .wait_s = params.retry_first_s}),
      life_(params.retry_first_s, params.retry_max_s) {}

Driver::~Driver() {
  close();
}

void Driver::start(Time now) {
  now_ = now;
  if (life_.phase() != Phase::Down) return;
  open_next(now);
  report(now);
}

void Driver::open_next(Time now) {
  const auto ready =
      std::ranges::find_if(turns_, [&](const Turn& t) { return now >= t.not_before; });
  if (ready == turns_.end()) return;
  at_ = static_cast<std::size_t>(ready - turns_.begin());
  const Caster& caster = casters_[at_];
  auto made = doors_.make_link(caster.address());
  if (!made) return fail(made.error().detail, now);
  link_ = std::move(*made);
  link_->on_bytes = [this](Bytes b, Time t) { on_bytes(b, t); };
  link_->on_closed = [this](const std::string& reason) {
    if (reply_.state() == Reply::State::Table) return on_table(now_);
    if (reply_.unauthorized()) return on_refused(now_);
    fail(caster_said_nothing() ? "the caster closed without an answer" : reason, now_);
  };
  reply_ = {};
  framer_.forget();
  other_.forget();
  frames_before_ = frames_;
  stuck_since_.reset();
  told_once_ = false;
  stage_ = Stage::Asking;
  since_ = now;
  ++connections_;
  life_.opening("connecting to " + caster.name());
  if (const auto opened = link_->open(); !opened) fail(opened.error().detail, now);
}

bool Driver::caster_said_nothing() const noexcept {
  return stage_ == Stage::Waiting && reply_.state() == Reply::State::Head;
}

void Driver::tick(Time now) {
  now_ = now;
  old_.reset();
  if (life_.phase() == Phase::Down) return;
  if (stage_ == Stage::Closed) open_next(now);
  if (stage_ == Stage::Asking) ask(now);
  if (stuck_since_ && now - *stuck_since_ >= kStalledFrame) {
    framer_.give_up([&](const rtcm::Frame& f) { on_frame(f, now); });
    stuck_since_.reset();
  }
  if (stage_ == Stage::Streaming) tell_position(now);
  look_up_the_list(now);
  check_silence(now);
  report(now);
}

/// With one write: simple casters read the first segment only.
void Driver::ask(Time now) {
  const Caster& caster = casters_[at_];
  std::string authorization;
  if (const auto& challenge = turns_[at_].challenge) {
    const std::string once = std::to_string(now.time_since_epoch().count() ^ 0x5DEECE66D);
    authorization =
        digest_answer(*challenge, caster.login, "/" + caster.mountpoint, once).value_or("");
  }
  const std::string text = request(caster, params_.version, authorization);
  if (link_->write(bytes_of(text)) != link::SendResult::Sent) return;
  stage_ = Stage::Waiting;
  since_ = now;
  life_.opening("waiting for the answer of " + casters_[at_].name());
}

void Driver::on_bytes(Bytes bytes, Time now) {
  now_ = now;
  if (stage_ == Stage::Closed) return;
  bytes_ += bytes.size();
  const std::uint64_t before = frames_;
  reply_.feed(bytes, [&](Bytes data) {
    framer_.feed(data, [&](const rtcm::Frame& f) { on_frame(f, now); });
    other_.feed(data);
  });
  if (frames_ != before || !framer_.waiting()) stuck_since_.reset();
  if (framer_.waiting() && !stuck_since_) stuck_since_ = now;
  on_reply(now);
  if (stage_ == Stage::Streaming && other_.sure() && frames_ == frames_before_) {
    fail("the mountpoint sends RTCM 2; RTCM 3 is needed: choose another mountpoint", now, true);
  }
}

void Driver::on_reply(Time now) {
  switch (reply_.state()) {
    case Reply::State::Head:
    case Reply::State::Table:
      return;
    case Reply::State::Stream:
      if (stage_ == Stage::Streaming) return;
      stage_ = Stage::Streaming;
      since_ = streaming_since_ = now;
      if (life_.phase() != Phase::Up) {  // the first frame may have come with the answer
        life_.opening("waiting for corrections of " + casters_[at_].name());
      }
      return;
    case Reply::State::Refused:
      return on_refused(now);
    case Reply::State::Ended:
      if (stage_ == Stage::Streaming) return fail("the caster ended the stream", now);
      return on_table(now);
  }
}

/// Once by the way that the caster wants, and once more if what it gave for that was too old.
void Driver::on_refused(Time now) {
  constexpr int kTries = 2;
  Turn& turn = turns_[at_];
  const auto& asked = reply_.challenge();
  const bool other = asked && asked != turn.challenge;
  if (other && turn.challenged < kTries && !casters_[at_].login.empty()) {
    if (!digest_answer(*asked, casters_[at_].login, "/", "x")) {
      return fail("the caster wants the login as a Digest by " + asked->algorithm +
                      ", which is not known here",
                  now, true);
    }
    turn.challenge = asked;
    ++turn.challenged;
    turn.not_before = now;
    close();
    life_.opening("logging in at " + casters_[at_].name());
    return report(now);
  }
  turn.challenge.reset();
  turn.challenged = 0;
  fail(reply_.refusal(), now, reply_.unauthorized());
}

/// A table instead of a stream: there is no such mountpoint, or none was named.
void Driver::on_table(Time now) {
  mountpoints_ = listed(reply_.sources());
  const std::string& wanted = casters_[at_].mountpoint;
  fail((wanted.empty() ? "no mountpoint is named" : "the caster has no mountpoint " + wanted) +
           "; it has: " + mountpoints_,
       now, true);
}

void Driver::on_frame(const rtcm::Frame& frame, Time now) {
  ++frames_;
  by_number_[frame.number] += 1;
  heard_[frame.number] = now;
  last_frame_ = now;
  since_ = now;
  turns_[at_].wait_s = params_.retry_first_s;
  turns_[at_].challenged = 0;
  if (!doors_.on_frame(frame.bytes)) ++lost_;
  if (life_.phase() == Phase::Up) return;
  life_.up();
  report(now);
}

void Driver::check_silence(Time now) {
  const double silent_s = base::seconds(now - since_);
  if ((stage_ == Stage::Asking || stage_ == Stage::Waiting) && silent_s > params_.reply_timeout_s) {
    if (reply_.unauthorized()) return on_refused(now);
    fail("the caster does not answer", now);
  } else if (stage_ == Stage::Streaming && silent_s > params_.silent_after_s) {
    fail("no corrections: the caster is silent", now);
  }
}

/// What stands first in the list is what the owner wants; the others are for when it is away.
void Driver::look_up_the_list(Time now) {
  if (stage_ != Stage::Streaming || params_.return_after_s <= 0.0) return;
  if (base::seconds(now - streaming_since_) < params_.return_after_s) return;
  const auto end = turns_.begin() + static_cast<std::ptrdiff_t>(at_);
  if (std::none_of(turns_.begin(), end, [&](const Turn& t) { return now >= t.not_before; })) return;
  ++returns_;
  turns_[at_].not_before = now;
  close();
  open_next(now);
}

void Driver::tell_position(Time now) {
  if (params_.gga_period_s <= 0.0 || !doors_.where) return;
  if (told_once_ && base::seconds(now - told_) < params_.gga_period_s) return;
  const base::GnssFix fix = doors_.where();
  if (base::seconds(now - fix.stamp) > kFixReach_s) return;
  const std::string line = gga_of(fix);
  if (line.empty() || link_->write(bytes_of(line)) != link::SendResult::Sent) return;
  ++positions_;
  told_once_ = true;
  told_ = now;
}

void Driver::fail(const std::string& reason, Time now, bool wait_long) {
  Turn& turn = turns_[at_];
  if (wait_long) turn.wait_s = params_.retry_max_s;
  turn.not_before = now + base::from_seconds(turn.wait_s);
  turn.wait_s = std::min(turn.wait_s * 2.0, params_.retry_max_s);
  close();
  life_.faulty(casters_[at_].name() + ": " + reason, now);
  report(now);
}

void Driver::close() {
  stage_ = Stage::Closed;
  if (!link_) return;
  link_->close();
  old_ = std::move(link_);
}

void Driver::stop(Time now) {
  now_ = now;
  if (life_.phase() == Phase::Down) return;
  close();
  for (Turn& turn : turns_) turn = {.not_before = {}, .wait_s = params_.retry_first_s};
  life_.down();
  report(now);
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

void Driver::report(Time now) {
  if (life_.report_due(now)) doors_.on_measurement(status(now));
}

base::DriverStatus Driver::status(Time now) const {
  base::DriverStatus s;
  s.stamp = now;
  s.name = name_;
  s.phase = life_.phase();
  s.reason = life_.reason();
  s.received = frames_;
  s.refused = framer_.counts().bad_crc;
  s.sent = positions_;
  s.last_received = last_frame_;
  s.link = casters_[at_].name();
  s.link_open = stage_ == Stage::Waiting || stage_ == Stage::Streaming;
  auto detail = std::make_shared<base::DriverDetail>();
  detail->counts = tallies();
  if (reply_.version() > 0) {
    detail->facts["protocol"] = "NTRIP " + std::to_string(reply_.version());
  }
  if (!mountpoints_.empty()) detail->facts["mountpoints"] = mountpoints_;
  for (const auto& [number, at] : heard_) {
    detail->facts["age of RTCM3 " + std::to_string(number)] =
        std::to_string(std::lround(base::seconds(now - at))) + " s";
  }
  s.detail = std::move(detail);
  return s;
}

std::map<std::string, std::uint64_t> Driver::tallies() const {
  std::map<std::string, std::uint64_t> out;
  const auto count = [&out](const std::string& what, std::uint64_t n) {
    if (n > 0) out.emplace(what, n);
  };
  for (const auto& [number, n] : by_number_) count("RTCM3 " + std::to_string(number), n);
  count("RTCM3 frame with a wrong checksum", framer_.counts().bad_crc);
  count("bytes outside any frame", framer_.counts().other_bytes);
  count("frame for which the receiver had no room", lost_);
  count("bytes", bytes_);
  count("position told to the caster", positions_);
  count("connection", connections_);
  count("return to a caster further up", returns_);
  return out;
}

}  // namespace roverd::ntrip
