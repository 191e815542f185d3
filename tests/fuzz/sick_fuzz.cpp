// Any bytes through framer and scan telegrams; cut elsewhere they give the same telegrams, what is
// believed is written and read again, and no number comes out that is none. Then as a scanner at
// the driver's port.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "link/memory.hpp"
#include "sick/driver.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

void check_sight(const base::Sight& sight) {
  check(!sight.points.empty() && std::isfinite(sight.half_step_rad));
  for (const base::SightPoint& p : sight.points) {
    check(std::isfinite(p.x_m) && std::isfinite(p.y_m) && std::isfinite(p.after_s));
    check(p.after_s >= 0.0F && p.after_s <= 10.1F);
  }
}

void check_scan(const sick::Telegram& telegram) {
  const auto scan = sick::decode_scan(telegram);
  if (!scan) return check(!scan.error().detail.empty());
  for (const sick::Channel& c : scan->channels) check(c.scale > 0.0F && std::isfinite(c.offset));
  const auto sight = sick::to_sight(*scan, {});
  if (sight) check_sight(*sight);
  // Written as it was read: longer only by leading zeros that are not written.
  const auto again = sick::encode(*scan, telegram.dialect);
  sick::Framer framer;
  framer.feed(again, [&](const sick::Telegram& t) {
    const auto same = sick::decode_scan(t);
    check(same && same->channels.size() == scan->channels.size());
    for (std::size_t i = 0; i < same->channels.size(); ++i) {
      check(same->channels[i].values == scan->channels[i].values);
    }
  });
  check(framer.counts().telegrams == 1);
}

void check_telegram(const sick::Telegram& telegram) {
  check(telegram.body.size() <= sick::kMaxBody);
  const auto words = sick::words_of(telegram);
  if (!words) return;
  check(words->fields_at <= telegram.body.size());
  static_cast<void>(sick::refusal_in(telegram, *words));
  static_cast<void>(sick::state_in(telegram, *words));
  check(sick::letters_in(telegram, *words).size() <= 64);
  for (int i = 0; i < 3; ++i) {
    sick::Fields in(telegram.dialect, telegram.body, words->fields_at);
    if (i == 0) sick::read_scan_config(in);
    if (i == 1) sick::read_output_range(in);
    if (i == 2) sick::read_data_config(in);
  }
  check_scan(telegram);
}

std::uint64_t run(base::Bytes bytes, std::size_t piece) {
  sick::Framer framer;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    framer.feed(bytes.subspan(at, std::min(piece, bytes.size() - at)), check_telegram);
  }
  framer.give_up(check_telegram);
  check(!framer.waiting());
  return framer.counts().telegrams;
}

void drive(base::Bytes bytes, unsigned choice) {
  sick::Params params;
  params.configure = (choice & 1U) != 0;
  params.dialect = (choice & 2U) != 0 ? "b" : "a";
  params.every = (choice & 4U) != 0 ? 3 : 1;
  auto wire = link::memory_byte_pair();
  std::uint64_t count = 0;
  sick::Driver driver(
      "lms", params,
      [&wire] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(wire.a)); },
      [](const base::Measurement&) {},
      [&count](const std::shared_ptr<const base::Sight>& sight) {
        check_sight(*sight);
        check(sight->count >= count);
        count = sight->count + 1;
      });
  base::Time now{std::chrono::seconds(10)};
  wire.b->set_immediate([&now] { return now; });
  check(wire.b->open().has_value());
  driver.start(now);
  const std::size_t piece = choice / 8U + 1U;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    now += std::chrono::milliseconds(10);
    wire.b->write(bytes.subspan(at, std::min(piece, bytes.size() - at)));
    driver.tick(now);
  }
  // As a whole binary telegram, for the checksum hides it from the fuzzer.
  wire.b->write(sick::frame(sick::Dialect::B, bytes.first(std::min(bytes.size(), sick::kMaxBody))));
  for (int i = 0; i < 100; ++i) {
    now += std::chrono::milliseconds(50);
    driver.tick(now);
  }
  check(driver.status(now).detail->counts.size() < 200);
  driver.stop(now);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const base::Bytes bytes(data + 1, size - 1);
  check(run(bytes, std::max<std::size_t>(bytes.size(), 1)) == run(bytes, data[0] % 64U + 1U));
  check_telegram({sick::Dialect::A, bytes.first(std::min(bytes.size(), sick::kMaxBody))});
  check_telegram({sick::Dialect::B, bytes.first(std::min(bytes.size(), sick::kMaxBody))});
  drive(bytes, data[0]);
  return 0;
}
