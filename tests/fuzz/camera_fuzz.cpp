// Any answer of an IP camera, cut anywhere the same; and any bytes as a picture.

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "camera/answer.hpp"
#include "camera/jpeg.hpp"
#include "camera/source.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

struct Outcome {
  camera::Answer answer;
  std::vector<std::string> pictures;
};

Outcome run(base::Bytes bytes, std::size_t piece) {
  Outcome out;
  const camera::OnPart take = [&out](base::Bytes b, base::Time) {
    check(!b.empty() && b.size() <= camera::kMaxPicture);
    out.pictures.emplace_back(b.begin(), b.end());
  };
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    out.answer.feed(bytes.subspan(at, std::min(piece, bytes.size() - at)), {}, take);
  }
  out.answer.end(take);
  return out;
}

/// What its markers tell holds for its pixels, too.
void look(base::Bytes bytes) {
  const auto shape = camera::shape_of(bytes);
  if (!shape) return;
  check(shape->scan <= shape->size && shape->size <= bytes.size());
  check(shape->width > 0 && shape->width <= camera::kLargest_px);
  constexpr int kQuick = 256;  // larger ones take too long here
  if (shape->width > kQuick || shape->height > kQuick) return;
  if (const auto grey = camera::grey_of(bytes)) {
    check(grey->width == shape->width && grey->height == shape->height);
  }
  static_cast<void>(camera::smaller(bytes, 4, 70));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const base::Bytes bytes(data + 1, size - 1);
  const Outcome whole = run(bytes, std::max<std::size_t>(bytes.size(), 1));
  const Outcome pieces = run(bytes, data[0] % 64U + 1U);
  check(whole.pictures == pieces.pictures);
  check(whole.answer.state() == pieces.answer.state());
  check(whole.answer.refusal() == pieces.answer.refusal());
  check(whole.answer.refused() == pieces.answer.refused());
  for (const std::string& one : whole.pictures) {
    look({reinterpret_cast<const std::uint8_t*>(one.data()), one.size()});
  }
  look(bytes);
  if (const auto source = camera::parse_source(std::string(bytes.begin(), bytes.end()))) {
    const auto asked = camera::request(*source, {.basic = true}, "c").value();
    check(asked.find("\r\n\r\n") == asked.size() - 4);
  }
  return 0;
}
