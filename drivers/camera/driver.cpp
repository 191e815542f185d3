#include "camera/driver.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace roverd::camera {

using Phase = base::DriverPhase;

namespace {

constexpr base::Duration kRateOver = std::chrono::seconds(2);
constexpr std::size_t kMostLately = 256;
/// Asked so often in a row how it wants the login.
constexpr int kMostWishes = 2;

Bytes as_bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

Driver::Driver(std::string name, const Params& params, std::optional<Source> source, Doors doors)
    : name_(std::move(name)),
      params_(params),
      source_(std::move(source)),
      doors_(std::move(doors)),
      life_(params.retry_first_s, params.retry_max_s) {}

Driver::~Driver() {
  close();
}

void Driver::start(Time now) {
  now_ = now;
  if (life_.phase() != Phase::Down) return;
  heard_ = now;
  open(now);
  report(now);
}

void Driver::open(Time now) {
  auto made = doors_.make_link();
  if (!made) return fail(made.error().detail, now);
  link_ = std::move(*made);
  link_told_ = link_->describe();
  link_->on_bytes = [this](Bytes b, Time t) { on_bytes(b, t); };
  link_->on_closed = [this](const std::string& reason) { on_closed(reason); };
  answer_ = {};
  counted_.clear();
  stage_ = source_ ? Stage::Asking : Stage::Hearing;
  asked_ = now;
  if (life_.phase() != Phase::Up) {  // between single pictures it stays up
    heard_ = now;
    life_.opening("waiting for a picture");
  }
  if (const auto opened = link_->open(); !opened) fail(opened.error().detail, now);
}

void Driver::tick(Time now) {
  now_ = now;
  old_.reset();
  if (life_.phase() == Phase::Down) return;
  const bool due =
      stage_ == Stage::Resting || life_.phase() != Phase::Faulty || life_.retry_due(now);
  if ((stage_ == Stage::Closed || stage_ == Stage::Resting) && due && now >= wait_until_) open(now);
  if (stage_ == Stage::Asking) ask(now);
  check_silence(now);
  report(now);
}

void Driver::ask(Time now) {
  const std::string once = std::to_string(now.time_since_epoch().count() ^ 0x5DEECE66D);
  const auto text = request(*source_, wish_, once);
  if (!text) {
    wish_ = {};
    return fail("it wants the login as a digest of a kind that is not known here", now, true);
  }
  if (link_->write(as_bytes(*text)) == link::SendResult::Sent) stage_ = Stage::Hearing;
}

void Driver::on_bytes(Bytes bytes, Time stamp) {
  now_ = std::max(now_, stamp);
  if (stage_ != Stage::Hearing) return;
  bytes_ += bytes.size();
  if (!source_) return on_picture(bytes, stamp);
  answer_.feed(bytes, stamp, [this](Bytes b, Time t) { on_picture(b, t); });
  count_refused();
  on_answer(now_);
}

void Driver::on_closed(const std::string& reason) {
  if (stage_ == Stage::Hearing && source_) {
    answer_.end([this](Bytes b, Time t) { on_picture(b, t); });
    if (answer_.state() == Answer::State::Ended && answer_.single()) return rest(now_);
  }
  if (stage_ == Stage::Closed || stage_ == Stage::Resting) return;
  fail(reason, now_);
}

void Driver::on_answer(Time now) {
  if (answer_.state() == Answer::State::Refused) return on_refused(now);
  if (answer_.state() != Answer::State::Ended) return;
  if (answer_.single()) return rest(now);
  fail("the camera ended its stream", now);
}

/// Once by the way that it wants, and once more if what it gave for that was too old.
void Driver::on_refused(Time now) {
  const Wish& asked = answer_.wish();
  const bool told = asked.digest || asked.basic;
  if (answer_.unauthorized() && told && !source_->login.empty() && asked != wish_ &&
      wished_ < kMostWishes) {
    wish_ = asked;
    ++wished_;
    close();
    wait_until_ = now;
    stage_ = Stage::Resting;
    return;
  }
  wish_ = {};
  wished_ = 0;
  if (!answer_.unauthorized()) return fail(answer_.refusal(), now);
  fail(source_->login.empty() ? "it wants a login" : "it refuses the login", now, true);
}

void Driver::on_picture(Bytes bytes, Time began) {
  if (bytes.size() > kMaxPicture) return refuse("picture of more than 4 MB");
  const auto shape = shape_of(bytes);
  if (!shape) return refuse(shape.error().detail);
  wished_ = 0;
  const Bytes scan = bytes.first(shape->size).subspan(shape->scan);
  same_ = last_ != nullptr && std::ranges::equal(scan, Bytes(last_->jpeg).subspan(last_scan_));
  if (same_) {
    ++twice_;
    ++counts_["same picture again"];
    return;
  }
  auto picture = std::make_shared<base::Picture>();
  picture->camera = name_;
  picture->stamp = began;
  picture->count = pictures_++;
  picture->width = shape->width;
  picture->height = shape->height;
  picture->jpeg.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(shape->size));
  last_ = picture;
  last_scan_ = shape->scan;
  heard_ = now_;
  lately_.push_back(now_);
  if (lately_.size() > kMostLately) lately_.pop_front();
  doors_.on_picture(std::move(picture));
  if (life_.phase() == Phase::Up) return;
  life_.up();
  report(now_);
}

void Driver::check_silence(Time now) {
  if (stage_ == Stage::Closed) return;
  const double silent_s = base::seconds(now - heard_);
  const std::string why = same_ ? "the same picture again and again" : "no new picture";
  if (silent_s > params_.silent_after_s && life_.phase() == Phase::Up) life_.faulty(why, now);
  // One that hangs may come to itself by this, too.
  const Time since = std::max(heard_, asked_);
  if (base::seconds(now - since) > params_.silent_reopen_s && stage_ != Stage::Resting) {
    fail(why, now);
  }
}

/// Until the next single picture is due.
void Driver::rest(Time now) {
  close();
  stage_ = Stage::Resting;
  wait_until_ = std::max(now, asked_ + base::from_seconds(1.0 / params_.images_hz));
}

void Driver::fail(const std::string& reason, Time now, bool wait_long) {
  close();
  wait_until_ = wait_long ? now + base::from_seconds(params_.retry_max_s) : now;
  life_.faulty(reason, now);
  report(now);
}

void Driver::close() {
  stage_ = Stage::Closed;
  same_ = false;
  if (!link_) return;
  link_->close();
  old_ = std::move(link_);
}

void Driver::stop(Time now) {
  now_ = now;
  if (life_.phase() == Phase::Down) return;
  close();
  wish_ = {};
  wished_ = 0;
  wait_until_ = {};
  last_.reset();
  lately_.clear();
  life_.down();
  report(now);
}

void Driver::restart(Time now) {
  stop(now);
  start(now);
}

void Driver::refuse(const std::string& cause, std::uint64_t more) {
  refused_ += more;
  counts_[cause] += more;
  refused_last_ = cause;
  refused_last_at_ = now_;
}

void Driver::count_refused() {
  for (const auto& [cause, n] : answer_.refused()) {
    std::uint64_t& told = counted_[cause];
    if (n > told) refuse(cause, n - told);
    told = n;
  }
}

void Driver::report(Time now) {
  if (life_.report_due(now)) doors_.on_measurement(status(now));
}

std::string Driver::link_name() const {
  return source_ ? source_->name() : link_told_;
}

base::DriverStatus Driver::status(Time now) const {
  base::DriverStatus s;
  s.stamp = now;
  s.name = name_;
  s.phase = life_.phase();
  s.reason = life_.reason();
  s.received = pictures_;
  s.refused = refused_;
  if (last_) s.last_received = heard_;
  s.link = link_name();
  s.link_open = stage_ == Stage::Hearing || stage_ == Stage::Resting;
  auto detail = std::make_shared<base::DriverDetail>();
  detail->counts = counts_;
  detail->counts["bytes"] = bytes_;
  detail->twice = twice_;
  detail->refused_last = refused_last_;
  detail->refused_last_at = refused_last_at_;
  const auto recent = std::ranges::count_if(lately_, [&](Time t) { return now - t <= kRateOver; });
  detail->rates_hz["picture"] = static_cast<double>(recent) / base::seconds(kRateOver);
  if (last_) {
    detail->facts["size"] = std::to_string(last_->width) + "x" + std::to_string(last_->height);
    detail->facts["picture_bytes"] = std::to_string(last_->jpeg.size());
  }
  if (source_ && pictures_ > 0) {
    detail->facts["gives"] = answer_.single() ? "one picture at a time" : "a stream";
  }
  s.detail = std::move(detail);
  return s;
}

}  // namespace roverd::camera
