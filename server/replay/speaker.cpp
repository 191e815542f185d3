#include "replay/speaker.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "ackermann/codec.hpp"
#include "bumper/codec.hpp"
#include "cloud/codec.hpp"
#include "gnss/decoder.hpp"
#include "gpsd/report.hpp"
#include "link/replay_file.hpp"
#include "mti/xbus.hpp"
#include "ranges/codec.hpp"
#include "ratio/codec.hpp"
#include "rtcm/framer.hpp"
#include "sick/cola.hpp"
#include "twist/binary.hpp"
#include "twist/text.hpp"
#include "velodyne/codec.hpp"
#include "vision/codec.hpp"

namespace roverd {
namespace {

/// So much of a file tells whose bytes they are.
constexpr std::size_t kEnough = 65'536;
constexpr std::size_t kMost = 4'000'000;
/// Of a line: numbers alone may be anybody's.
constexpr double kMetres = 1.0;
constexpr const char* kRangers = "ranges";

/// A drive link in both directions.
struct DriveEars {
  ratio::Decoder ratio;
  twist::TextDecoder text;
  twist::BinaryDecoder binary;
};

/// All who might have spoken listen; each counts what it understands.
class Jury {
 public:
  void hear(base::Bytes bytes, base::Time now) {
    seen_ += bytes.size();
    receiver_.feed(bytes, now, [](const gnss::Sentence&, base::Time) {});
    unit_.feed(bytes, [](const mti::Message&) {});
    corrections_.feed(bytes, [](const rtcm::Frame&) {});
    bumper_.feed(bytes, [this](std::uint8_t) { ++bumpers_; });
    lines_.feed(bytes, [this](std::string_view line) {
      if (line.starts_with("{\"class\":")) ++reports_;
    });
    hear_drive(back_, bytes);
    hear_sensors(bytes);
  }
  void hear_sent(base::Bytes bytes) {
    seen_ += bytes.size();
    hear_drive(forth_, bytes);
  }
  std::size_t seen() const noexcept { return seen_; }
  bool hears_nobody() const {
    return std::ranges::all_of(votes(), [](const auto& vote) { return vote.second == 0; });
  }

  std::string verdict() const {
    const auto all = votes();
    const auto* best = all.data();
    for (const auto& vote : all) {
      // Lines of numbers may be anybody's: rangers are heard where nobody else is.
      const bool others = best->second > 0 && vote.first == kRangers;
      if (vote.second > best->second && !others) best = &vote;
    }
    return best->first;
  }

 private:
  using Votes = std::array<std::pair<const char*, std::uint64_t>, 13>;
  Votes votes() const {
    return {{
        {"gnss", receiver_.counts().intact()},
        {"mti", unit_.counts().messages},
        {"gpsd", reports_},
        {"ntrip", corrections_.counts().frames},
        {"ackermann", datagrams_},
        {"ratio", ratios_},
        {"twist", twists_},
        {"bumper", bumpers_},
        {"sick", scanner_.counts().telegrams},
        {"velodyne", packets_},
        {"vision", visions_},
        {"cloud", images_},
        {kRangers, ranges_},
    }};
  }
  void hear_drive(DriveEars& ears, base::Bytes bytes) {
    if (ackermann::decode(bytes).fault == ackermann::Fault::None) ++datagrams_;
    ears.ratio.feed(bytes, [this](const ratio::Message&) { ++ratios_; });
    const auto said = [this](const twist::Said&) { ++twists_; };
    ears.text.feed(bytes, said);
    ears.binary.feed(bytes, said);
  }

  void hear_sensors(base::Bytes bytes) {
    scanner_.feed(bytes, [](const sick::Telegram&) {});
    if (velodyne::decode(bytes).fault == velodyne::Fault::None) ++packets_;
    if (vision::decode(bytes).fault == vision::Fault::None) ++visions_;
    camera_.feed(bytes, [this](const cloud::Frame&) { ++images_; });
    range_lines_.feed(
        bytes,
        [this](std::string_view line) {
          if (ranges::parse(line, kMetres).fault == nullptr) ++ranges_;
        },
        [] {});
  }

  gnss::Decoder receiver_;
  mti::Framer unit_;
  rtcm::Framer corrections_;
  bumper::Decoder bumper_;
  gpsd::Lines lines_;
  DriveEars back_, forth_;
  sick::Framer scanner_;
  cloud::Decoder camera_{cloud::kMaxPoints};
  ranges::Lines range_lines_;
  std::uint64_t packets_ = 0;
  std::uint64_t visions_ = 0;
  std::uint64_t images_ = 0;
  std::uint64_t ranges_ = 0;
  std::uint64_t reports_ = 0;
  std::uint64_t datagrams_ = 0;
  std::uint64_t ratios_ = 0;
  std::uint64_t twists_ = 0;
  std::uint64_t bumpers_ = 0;
  std::size_t seen_ = 0;
};

}  // namespace

std::string speaker_of(const std::string& path, const link::ReplayOptions& how) {
  Jury jury;
  link::ByteFile file(
      path, how, [&](base::Bytes bytes, base::Time now) { jury.hear(bytes, now); },
      [&](base::Bytes bytes, base::Time) { jury.hear_sent(bytes); });
  if (!file.open()) return "gnss";
  while (jury.seen() < kEnough || (jury.seen() < kMost && jury.hears_nobody())) {
    const auto next = file.advance();
    if (!next) return jury.verdict();
    if (!*next) break;
    file.emit(base::Time{**next});
  }
  return jury.seen() > 0 ? jury.verdict() : std::string();
}

}  // namespace roverd
