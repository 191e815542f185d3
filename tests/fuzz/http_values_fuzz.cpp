// Values that clients write into addresses and headers: whatever the bytes, no crash, and what is
// accepted keeps its promises.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "api/guard.hpp"
#include "api/json/rfc3339.hpp"
#include "api/json/words.hpp"
#include "api/router.hpp"
#include "net/assets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roverd;
  const std::string_view text(reinterpret_cast<const char*>(data), size);

  if (const auto decoded = api::percent_decoded(text); decoded && decoded->size() > size) abort();
  if (const auto target = api::parse_target(text)) {
    static const api::Router kRouter = [] {
      api::Router router;
      router.add({api::http::verb::get, "/missions/{id}/export", {200}, {}});
      router.add({api::http::verb::get, "/tiles/{set}/{z}/{x}/{y}", {200}, {}});
      return router;
    }();
    kRouter.find(api::http::verb::get, target->path);
  }
  if (const auto time = api::from_rfc3339(text);
      time && time->time_since_epoch().count() < -86'400'000'000'000) {
    abort();
  }
  const auto revision = api::revision_of(text);
  if (revision && api::etag_of(*revision) != text) abort();
  if (api::is_loopback_host(text) && size > sizeof("localhost:65535")) abort();
  if (const auto name = api::bare_name(text); name.size() > size) abort();
  (void)net::none_match_hits(text, "\"a\"");
  if (net::choose_coding(text, false, false) != net::Coding::Identity) abort();
  (void)net::choose_coding(text, true, true);
  return 0;
}
