#include "bunker/tally.hpp"

#include <algorithm>
#include <cstdio>

namespace roverd::bunker {
namespace {

std::string words_of(Cause cause, std::uint32_t id, const Impossible& detail) {
  switch (cause) {
    case Cause::Remote:
      return "remote frame";
    case Cause::ErrorFrame:
      return "error frame";
    case Cause::Extended:
      return "extended id";
    case Cause::UnknownId:
      return "unknown id " + id_text(id);
    case Cause::TooShort:
      return id_text(id) + " too short";
    case Cause::BadValue:
      return id_text(id) + " with an unlisted code";
    case Cause::BadChecksum:
      return id_text(id) + " with a wrong checksum";
    case Cause::Impossible: {
      std::array<char, 32> value{};
      std::snprintf(value.data(), value.size(), " %.10g", detail.value);
      return "impossible value in " + id_text(id) + ": " + std::string(detail.what) + value.data() +
             std::string(detail.unit);
    }
    case Cause::Frozen:
      return id_text(id) + " count frozen";
    case Cause::ForeignCommand:
      return "somebody else's command " + id_text(id);
    case Cause::NotThisProtocol:
      return id_text(id) + " is not of this base's protocol";
  }
  return "?";
}

}  // namespace

std::string id_text(std::uint32_t id) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "0x%03X", static_cast<unsigned>(id));
  return text.data();
}

void Tally::add(Cause cause, std::uint32_t id, const Impossible& detail) noexcept {
  const auto end = lines_.begin() + static_cast<std::ptrdiff_t>(used_);
  const auto line = std::find_if(lines_.begin(), end, [&](const Line& l) {
    return l.cause == cause && l.id == id && l.detail.what == detail.what;
  });
  if (line != end) {
    ++line->count;
  } else if (cause == Cause::UnknownId && unknown_ids_ == kUnknownIds) {
    ++other_unknown_;
  } else if (used_ == kMost) {
    ++other_;
  } else {
    if (cause == Cause::UnknownId) ++unknown_ids_;
    lines_[used_++] = {cause, id, detail, 1};
  }
}

std::map<std::string, std::uint64_t> Tally::words() const {
  std::map<std::string, std::uint64_t> out;
  for (std::size_t i = 0; i < used_; ++i) {
    out[words_of(lines_[i].cause, lines_[i].id, lines_[i].detail)] += lines_[i].count;
  }
  if (other_unknown_ > 0) out["other unknown ids"] = other_unknown_;
  if (other_ > 0) out["other causes"] = other_;
  return out;
}

void Rates::add(std::uint32_t id) noexcept {
  std::size_t i = 0;
  while (i < used_ && slots_[i].id != id) ++i;
  if (i == used_) {
    if (used_ == kIds) return;
    slots_[used_++] = {id, 0};
  }
  ++slots_[i].count;
}

const std::map<std::string, double>& Rates::words(base::Time now) {
  if (now - since_ < kWindow) return words_;
  const double elapsed_s = base::seconds(now - since_);
  for (std::size_t i = 0; i < used_; ++i) {
    words_[id_text(slots_[i].id)] = slots_[i].count / elapsed_s;
    slots_[i].count = 0;
  }
  since_ = now;
  return words_;
}

}  // namespace roverd::bunker
