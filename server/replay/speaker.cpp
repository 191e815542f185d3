#include "replay/speaker.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "ackermann/codec.hpp"
#include "bumper/codec.hpp"
#include "gnss/decoder.hpp"
#include "gpsd/report.hpp"
#include "link/replay_file.hpp"
#include "mti/xbus.hpp"
#include "ratio/codec.hpp"
#include "rtcm/framer.hpp"
#include "twist/binary.hpp"
#include "twist/text.hpp"

namespace roverd {
namespace {

/// So much of a file tells whose bytes they are.
constexpr std::size_t kEnough = 65'536;

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
  }
  void hear_sent(base::Bytes bytes) {
    seen_ += bytes.size();
    hear_drive(forth_, bytes);
  }
  std::size_t seen() const noexcept { return seen_; }

  std::string verdict() const {
    const std::array<std::pair<const char*, std::uint64_t>, 8> votes{{
        {"gnss", receiver_.counts().intact()},
        {"mti", unit_.counts().messages},
        {"gpsd", reports_},
        {"ntrip", corrections_.counts().frames},
        {"ackermann", datagrams_},
        {"ratio", ratios_},
        {"twist", twists_},
        {"bumper", bumpers_},
    }};
    const auto* best = votes.data();
    for (const auto& vote : votes) {
      if (vote.second > best->second) best = &vote;
    }
    return best->first;
  }

 private:
  void hear_drive(DriveEars& ears, base::Bytes bytes) {
    if (ackermann::decode(bytes).fault == ackermann::Fault::None) ++datagrams_;
    ears.ratio.feed(bytes, [this](const ratio::Message&) { ++ratios_; });
    const auto said = [this](const twist::Said&) { ++twists_; };
    ears.text.feed(bytes, said);
    ears.binary.feed(bytes, said);
  }

  gnss::Decoder receiver_;
  mti::Framer unit_;
  rtcm::Framer corrections_;
  bumper::Decoder bumper_;
  gpsd::Lines lines_;
  DriveEars back_, forth_;
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
  while (jury.seen() < kEnough) {
    const auto next = file.advance();
    if (!next) return jury.verdict();
    if (!*next) break;
    file.emit(base::Time{**next});
  }
  return jury.seen() > 0 ? jury.verdict() : std::string();
}

}  // namespace roverd
