#pragma once
// Settings of a SICK scanner. Angles as the robot has them: 0 ahead, left positive.

#include <string>

#include "base/params.hpp"

namespace roverd::sick {

struct Params {
  std::string model = "lms1xx";
  std::string dialect = "a";
  bool configure = false;
  double frequency_hz = 50.0;
  double resolution_deg = 0.5;
  double right_deg = -135.0;
  double left_deg = 135.0;
  int echoes = 1;
  bool remission = true;
  int every = 1;
  double ahead_deg = 90.0;
  double clear_to_m = 8.0;
  double silent_after_s = 1.0;
  double retry_first_s = 0.5;
  double retry_max_s = 5.0;
};

template <class V>
void fields(V& v, Params& p) {
  v("model", p.model, "lms1xx, lms5xx or tim: what may be configured");
  v("dialect", p.dialect, "a or b: the CoLa dialect that is tried first, then the other");
  v("configure", p.configure,
    "log in and tell the scanner what to send; otherwise it sends what is stored in it");
  v("frequency_hz", p.frequency_hz, 1.0, 100.0, "scans a second, once configured; not of a tim");
  v("resolution_deg", p.resolution_deg, 0.05, 5.0, "between two beams, once configured");
  v("right_deg", p.right_deg, -180.0, 180.0, "first beam that is sent, once configured");
  v("left_deg", p.left_deg, -180.0, 180.0, "last beam that is sent, once configured");
  v("echoes", p.echoes, 1, 5, "of each beam, once configured: glass, dust and rain give several");
  v("remission", p.remission, "how strong each echo was, too, once configured");
  v("every", p.every, 1, 100, "1: each scan is sent, 2: each second one; gaps beyond are losses");
  v("ahead_deg", p.ahead_deg, -180.0, 180.0,
    base::only_disarmed("the scanner's angle that is straight ahead: 90 of LMS and most TiM"));
  v("clear_to_m", p.clear_to_m, 0.0, 100.0,
    base::lower_is_stricter("where nothing came back it is clear so far; 0: nothing is known"));
  v("silent_after_s", p.silent_after_s, 0.2, 10.0, "without a scan the connection is made anew");
  v("retry_first_s", p.retry_first_s, 0.05, 60.0, "first wait before connecting again");
  v("retry_max_s", p.retry_max_s, 0.05, 600.0, "longest wait before connecting again");
}

/// What `fields` cannot say: words, and what an LMS1xx offers. The error names the field.
inline base::Result<void> validate(const Params& p) {
  const auto no = [](const char* field, const char* why) {
    return base::fail(base::Code::Invalid, std::string(field) + " " + why, {{field, why}});
  };
  if (p.model != "lms1xx" && p.model != "lms5xx" && p.model != "tim") {
    return no("model", "must be lms1xx, lms5xx or tim");
  }
  if (p.dialect != "a" && p.dialect != "b") return no("dialect", "must be a or b");
  if (!(p.right_deg < p.left_deg)) return no("right_deg", "must be less than left_deg");
  if (!p.configure || p.model != "lms1xx") return {};
  if (p.frequency_hz != 25.0 && p.frequency_hz != 50.0) {
    return no("frequency_hz", "must be 25 or 50 of an LMS1xx");
  }
  if (p.resolution_deg != 0.5 && (p.resolution_deg != 0.25 || p.frequency_hz != 25.0)) {
    return no("resolution_deg", "must be 0.5 of an LMS1xx, or 0.25 at 25 Hz");
  }
  if (p.echoes > 2) return no("echoes", "must be 1 or 2 of an LMS1xx");
  return {};
}

}  // namespace roverd::sick
