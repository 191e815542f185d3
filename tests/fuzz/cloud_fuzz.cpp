// Any bytes as a stream of clouds: the same frames however it is cut, every point finite, and
// bodies behind good checksums too, which the fuzzer would not find.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cloud/eye.hpp"

namespace {

using namespace roverd;

constexpr std::uint32_t kMostPoints = 2000;

void check(bool truth) {
  if (!truth) std::abort();
}

void look(const cloud::Frame& frame, int decimate) {
  cloud::Params params;
  params.decimate = decimate;
  params.clear_to_m = decimate % 2 == 0 ? 5.0 : 0.0;
  cloud::Eye eye(params);
  base::Sight sight;
  const auto seen = eye.look(frame, sight);
  check(sight.points.size() <= kMostPoints);
  check(seen.missing <= seen.directions);
  check(sight.half_step_rad >= 0.0F && sight.half_step_rad <= 1.6F);
  for (const base::SightPoint& p : sight.points) {
    check(std::isfinite(p.x_m) && std::isfinite(p.y_m) && std::isfinite(p.z_m));
  }
}

std::size_t run(base::Bytes bytes, std::size_t piece) {
  cloud::Decoder decoder(kMostPoints);
  std::size_t frames = 0;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    decoder.feed(bytes.subspan(at, std::min(piece, bytes.size() - at)),
                 [&](const cloud::Frame& frame) {
                   ++frames;
                   look(frame, 1);
                 });
  }
  check(decoder.refused().size() < 600);
  return frames;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const base::Bytes bytes(data + 2, size - 2);
  check(run(bytes, std::max<std::size_t>(bytes.size(), 1)) == run(bytes, data[0] % 64U + 1U));
  cloud::Header header;
  header.kind = static_cast<cloud::Kind>(data[1] % 3U + 1U);
  header.optical = data[1] % 2 == 0;
  if (data[1] % 5 == 0) header.pose = base::Mount{0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  const auto frame = cloud::decode_body(header, bytes, kMostPoints);
  if (frame) look(*frame, data[0] % 16 + 1);
  return 0;
}
