#include "nav/marks/by_source.hpp"

namespace roverd::nav::marks {
namespace {

// No two things have one number, whichever list is looked into.
constexpr std::uint32_t kNumbersOfScans = 1U << 30;
constexpr std::uint32_t kNumbersOfImages = 2U << 30;

}  // namespace

void BySource::begin(Source from, std::size_t eye) {
  eyes_[index(from)] |= eye_of(eye);
  if (two_ || eyes_[0] == 0 || eyes_[1] == 0) return;
  two_ = true;
  alone_[index(from == Source::Scan ? Source::Vision : Source::Scan)] = both_;
  for (std::size_t i = 0; i < alone_.size(); ++i) {
    const std::uint32_t first = i == index(Source::Scan) ? kNumbersOfScans : kNumbersOfImages;
    alone_[i].walls.number_from(first);
    alone_[i].landmarks.number_from(first);
  }
}

void BySource::tell(View& out) const {
  out.walls = both_.walls.all();
  out.landmarks = both_.landmarks.all();
  out.eyes = eyes_;
  if (!two_) return;
  for (std::size_t i = 0; i < alone_.size(); ++i) {
    out.alone[i] = {alone_[i].walls.all(), alone_[i].landmarks.all()};
  }
}

}  // namespace roverd::nav::marks
