#pragma once
// What is taken for a tag, and how a vehicle docks at one. Sections [nav.tags] and [nav.tag_dock].

#include "base/params.hpp"
#include "base/result.hpp"

namespace roverd::nav::tags {

struct TagParams {
  double size_m = 0.16;
  int max_hamming = 1;
  double min_margin = 25.0;
  double decimate = 1.0;
  double corner_sigma_px = 0.25;
  double max_doubt = 0.1;
};

template <class V>
void fields(V& v, TagParams& p) {
  v("size_m", p.size_m, 0.01, 2.0, "side of the tag's black border");
  v("max_hamming", p.max_hamming, 0, 2,
    base::lower_is_stricter("wrong bits that are put right; more of them invent tags"));
  v("min_margin", p.min_margin, 0.0, 255.0,
    base::higher_is_stricter("grey levels that its bits stand off black and white"));
  v("decimate", p.decimate, 1.0, 4.0,
    "borders are looked for in an image so many times smaller: quicker, and not so far");
  v("corner_sigma_px", p.corner_sigma_px, 0.02, 5.0, "1 sigma of a corner's place in the image");
  v("max_doubt", p.max_doubt, 0.0, 1.0,
    base::lower_is_stricter("its direction counts while the other pose that would look much the "
                            "same is less likely than this"));
}

struct TagDockParams {
  double stand_off_m = 0.8;
  double gate_m = 1.2;
  double straight_m = 0.3;
  double way_mps = 0.4;
  double dock_mps = 0.15;
  double within_m = 0.02;
  double within_deg = 1.0;
  double look_s = 0.6;
  double lost_s = 3.0;
};

template <class V>
void fields(V& v, TagDockParams& p) {
  v("stand_off_m", p.stand_off_m, 0.1, 5.0,
    "docked, the vehicle's origin is so far before the tag");
  v("gate_m", p.gate_m, 0.5, 5.0, "so far before that it comes onto the tag's line");
  v("straight_m", p.straight_m, 0.1, 2.0,
    "the last of the way is straight ahead, whatever is seen then");
  v("way_mps", p.way_mps, 0.05, 2.0, "on the way to the line");
  v("dock_mps", p.dock_mps, 0.05, 0.5, "on the line");
  v("within_m", p.within_m, 0.005, 0.5, "docked is who stands this close");
  v("within_deg", p.within_deg, 0.2, 20.0, "and points there this well");
  v("look_s", p.look_s, 0.1, 10.0, "standing on the line it looks so long before it goes on");
  v("lost_s", p.lost_s, 0.5, 60.0, "without the tag for so long, farther than straight_m: failed");
}

/// Invalid; the field is the parameter's name.
inline base::Result<void> check(const TagDockParams& p) {
  if (p.gate_m > p.straight_m) return {};
  return base::fail(base::Code::Invalid, "gate_m must be more than straight_m",
                    {{"gate_m", "must be more than straight_m"}});
}

}  // namespace roverd::nav::tags
