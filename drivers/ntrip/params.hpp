#pragma once
// Settings of the NTRIP client. The casters, with their logins, are the driver's link.

#include "base/params.hpp"

namespace roverd::ntrip {

struct Params {
  int version = 2;
  double gga_period_s = 10.0;
  double reply_timeout_s = 10.0;
  double silent_after_s = 30.0;
  double return_after_s = 600.0;
  double retry_first_s = 1.0;
  double retry_max_s = 60.0;
};

template <class V>
void fields(V& v, Params& p) {
  v("version", p.version, 1, 2,
    "of the protocol in which is asked; an answer in either is understood");
  v("gga_period_s", p.gga_period_s, 0.0, 60.0,
    "how often the caster is told where we are; 0: never (a single base needs it not)");
  v("reply_timeout_s", p.reply_timeout_s, 1.0, 60.0, "a caster that does not answer is left");
  v("silent_after_s", p.silent_after_s, 2.0, 300.0,
    "a caster without an intact correction for so long is left");
  v("return_after_s", p.return_after_s, 0.0, 86400.0,
    "so long a caster further down the list is used before those above it are tried again; 0: "
    "until it fails");
  v("retry_first_s", p.retry_first_s, 0.1, 60.0, "first wait before a caster is tried again");
  v("retry_max_s", p.retry_max_s, 1.0, 3600.0,
    "longest wait; a refused login waits so long at once");
}

}  // namespace roverd::ntrip
