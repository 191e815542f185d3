// What looks around.

#include "api/context.hpp"
#include "api/json/words.hpp"

namespace roverd::api {

void add_sensor_routes(const ContextPtr& c) {
  c->router.add({http::verb::get, "/sensors", {200, 503}, [c](const CallPtr& call) {
                   if (const auto s = c->snapshot_or_refuse(call)) {
                     call->respond(
                         json_response(http::status::ok, sensors_json(*s, base::steady_now())));
                   }
                 }});
  c->router.add({http::verb::get, "/landmarks", {200, 503}, [c](const CallPtr& call) {
                   if (const auto s = c->snapshot_or_refuse(call)) {
                     const auto seen = c->outlook();
                     call->respond(json_response(
                         http::status::ok, landmarks_json(seen.get(), *s, base::steady_now())));
                   }
                 }});
  c->router.add({http::verb::get, "/obstacles", {200, 503}, [c](const CallPtr& call) {
                   if (const auto s = c->snapshot_or_refuse(call)) {
                     const auto seen = c->outlook();
                     call->respond(json_response(
                         http::status::ok, obstacles_json(seen.get(), *s, base::steady_now())));
                   }
                 }});
}

}  // namespace roverd::api
