#include "sim/world/kinds.hpp"

namespace roverd::sim::world {
namespace {

constexpr Number kHeight{"height_m", &Thing::height_m, 0.01, 100.0};
constexpr Number kBottom{"bottom_m", &Thing::bottom_m, 0.0, 100.0};
constexpr Number kThickness{"thickness_m", &Thing::thickness_m, 0.005, 10.0};
constexpr Number kRadius{"radius_m", &Thing::radius_m, 0.002, 50.0};
constexpr Number kLength{"length_m", &Thing::length_m, 0.01, 1'000.0};
constexpr Number kWidth{"width_m", &Thing::width_m, 0.01, 1'000.0};
constexpr Number kDensity{"density_pm", &Thing::density_pm, 0.01, 1'000.0};
constexpr Number kReflect{"reflect", &Thing::reflect, 0.0, 1.0};
constexpr Number kSpacing{"spacing_m", &Thing::spacing_m, 0.02, 100.0};
constexpr Number kGaps{"gaps", &Thing::gaps, 0.0, 1.0};
constexpr Number kBend{"bend_m", &Thing::bend_m, -500.0, 500.0};
constexpr Number kSpeed{"speed_mps", &Thing::speed_mps, 0.01, 30.0};
constexpr Number kPause{"pause_s", &Thing::pause_s, 0.0, 86'400.0};
constexpr Number kSize{"size_m", &Thing::length_m, 0.02, 5.0};
constexpr Number kId{"id", &Thing::id, 0.0, 586.0};
constexpr Number kStart{"start_s", &Thing::start_s, 0.0, 86'400.0};

Thing like(Kind kind, double height_m, double length_m, double width_m, double radius_m,
           double thickness_m) {
  Thing t;
  t.kind = kind;
  t.height_m = height_m;
  t.length_m = length_m;
  t.width_m = width_m;
  t.radius_m = radius_m;
  t.thickness_m = thickness_m;
  return t;
}

}  // namespace

const std::vector<KindRow>& kinds() {
  static const std::vector<KindRow> rows = {
      {Kind::Wall,
       Places::Line,
       {kHeight, kThickness, kReflect},
       false,
       like(Kind::Wall, 2.0, 1.0, 1.0, 0.1, 0.2)},
      {Kind::Bar,
       Places::Line,
       {kHeight, kBottom, kThickness, kReflect},
       false,
       like(Kind::Bar, 0.1, 1.0, 1.0, 0.1, 0.1)},
      {Kind::Pole,
       Places::One,
       {kHeight, kRadius, kReflect},
       false,
       like(Kind::Pole, 2.0, 1.0, 1.0, 0.05, 0.2)},
      {Kind::Box,
       Places::One,
       {kHeight, kBottom, kLength, kWidth, kReflect},
       true,
       like(Kind::Box, 1.0, 1.0, 1.0, 0.1, 0.2)},
      {Kind::Cone,
       Places::One,
       {kHeight, kRadius, kReflect},
       false,
       like(Kind::Cone, 0.5, 1.0, 1.0, 0.18, 0.2)},
      {Kind::Bush,
       Places::One,
       {kHeight, kRadius, kDensity, kReflect},
       false,
       like(Kind::Bush, 1.0, 1.0, 1.0, 0.5, 0.2)},
      {Kind::Row,
       Places::Line,
       {kHeight, kWidth, kSpacing, kGaps, kBend, kDensity, kReflect},
       false,
       like(Kind::Row, 1.5, 1.0, 0.8, 0.1, 0.2)},
      {Kind::Person,
       Places::Path,
       {kHeight, kLength, kWidth, kSpeed, kPause, kStart, kReflect},
       false,
       like(Kind::Person, 1.75, 0.3, 0.46, 0.1, 0.2)},
      {Kind::Animal,
       Places::Path,
       {kHeight, kLength, kWidth, kSpeed, kPause, kStart, kReflect},
       false,
       like(Kind::Animal, 0.6, 0.8, 0.25, 0.1, 0.2)},
      {Kind::Tag,
       Places::One,
       {kId, kSize, kHeight, kReflect},
       true,
       like(Kind::Tag, 0.5, 0.16, 1.0, 0.1, 0.2)}};
  return rows;
}

std::string_view word_of(Motion motion) noexcept {
  return motion == Motion::Once ? "once" : motion == Motion::Loop ? "loop" : "back";
}

}  // namespace roverd::sim::world
