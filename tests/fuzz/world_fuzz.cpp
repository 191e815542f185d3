// Worlds: whatever the text, it is refused with a reason or gives one that survives a round trip,
// and whose rays and touches keep to their word.

#include <cmath>
#include <cstdlib>
#include <string_view>

#include "sim/world/contact.hpp"

using namespace roverd::sim::world;

namespace {

/// Larger ones are right too, and only slow.
bool small(const World& world) {
  double pieces = static_cast<double>(world.things.size());
  for (const Thing& t : world.things) {
    if (t.kind == Kind::Row) pieces += static_cast<double>(plants_of(t));
    for (std::size_t i = 1; i < t.points.size(); ++i) {
      pieces += length(t.points[i] - t.points[i - 1]) / 3.0;
    }
  }
  return pieces < 5'000.0;
}

void look_around(const World& world) {
  const Scene scene(world);
  const Moment now = scene.at(12.5);
  for (std::uint64_t i = 0; i < 32; ++i) {
    const double turn = static_cast<double>(i) * 0.196;
    const double down = static_cast<double>(i % 5) * -0.1;
    const double flat = std::sqrt(1.0 - down * down);
    const Ray ray{{0, 0, 0.5}, {flat * std::cos(turn), flat * std::sin(turn), down}};
    Draw draw(1, i);
    const Hit hit = scene.cast(ray, 50.0, now, draw);
    if (hit.any() && !(hit.range_m >= 0.0 && hit.range_m <= 50.0)) std::abort();
    if (!(hit.cosine >= 0.0 && hit.cosine <= 1.0)) std::abort();
  }
  const Body body = Body::rectangle(0.5, 0.5, 0.7, 0.4, 0.05);
  const Contact c = contact(scene, now, scene.terrain().stand({}, 1.0, 0.3, 0.3), body);
  if (!(c.clearance_m >= 0.0)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto world = read_world({reinterpret_cast<const char*>(data), size});
  if (!world) {
    if (world.error().detail.empty()) std::abort();
    return 0;
  }
  const auto again = read_world(write_world(*world));
  if (!again || again->things.size() != world->things.size()) std::abort();
  if (small(*world)) look_around(*world);
  return 0;
}
