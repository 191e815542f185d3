// Cameras of pictures: which there are, and the newest picture of each.

#include <algorithm>
#include <cmath>

#include "api/context.hpp"
#include "api/json/measured.hpp"

namespace roverd::api {

namespace {

double picture_age_s(const base::Picture& picture) {
  return std::max(0.0, base::seconds(base::steady_now() - picture.stamp));
}

const base::DriverStatus* driver_status_of(const base::Snapshot& s, const std::string& name) {
  const auto found = std::ranges::find(s.drivers, name, &base::DriverStatus::name);
  return found == s.drivers.end() ? nullptr : &*found;
}

Json camera_json(const CameraDoor::Camera& camera, const base::Snapshot& s) {
  const base::PicturePtr picture = camera.newest();
  Json out = {{"name", camera.name},
              {"kind", camera.kind},
              {"state", "down"},
              {"reason", nullptr},
              {"rate_hz", 0.0},
              {"refused", 0},
              {"repeated", 0},
              {"width", picture ? Json(picture->width) : Json(nullptr)},
              {"height", picture ? Json(picture->height) : Json(nullptr)},
              {"bytes", picture ? Json(picture->jpeg.size()) : Json(nullptr)},
              {"count", picture ? Json(picture->count) : Json(nullptr)},
              {"age_s", picture ? rounded(picture_age_s(*picture), kPlaces2) : Json(nullptr)}};
  const base::DriverStatus* status = driver_status_of(s, camera.name);
  if (status == nullptr) return out;
  out["state"] = base::to_string(status->phase);
  if (!status->reason.empty()) out["reason"] = status->reason;
  out["refused"] = status->refused;
  if (!status->detail) return out;
  out["repeated"] = status->detail->twice;
  const auto rate = status->detail->rates_hz.find("picture");
  if (rate != status->detail->rates_hz.end()) out["rate_hz"] = rounded(rate->second, kPlaces2);
  return out;
}

const CameraDoor::Camera* camera_of(const ContextPtr& c, const Call& call) {
  const auto& all = c->deps.cameras.cameras;
  const auto found = std::ranges::find(all, call.params.at("name"), &CameraDoor::Camera::name);
  return found == all.end() ? nullptr : &*found;
}

/// How old it is stands in the head, so that the page knows it however slow the way was.
void tell_picture(Response& response, const base::Picture& picture) {
  response.set("Picture-Count", std::to_string(picture.count));
  response.set("Picture-Age-Ms", std::to_string(std::lround(1000.0 * picture_age_s(picture))));
  response.set(http::field::cache_control, "no-store");
}

Response picture_response(const base::Picture& picture, const std::vector<std::uint8_t>& jpeg) {
  Response response =
      text_response(http::status::ok, "image/jpeg", std::string(jpeg.begin(), jpeg.end()));
  tell_picture(response, picture);
  return response;
}

void answer_picture(const ContextPtr& c, const CallPtr& call) {
  const CameraDoor::Camera* camera = camera_of(c, *call);
  if (camera == nullptr) {
    return call->respond(
        problem({base::Code::NotFound, "no camera \"" + call->params.at("name") + "\""}));
  }
  std::vector<base::FieldError> errors;
  const auto number = [&](const char* name) -> std::optional<std::int64_t> {
    const std::string text = query_text(*call, name);
    if (text.empty()) return {};
    const auto value = whole_number(text);
    if (!value) errors.push_back({name, "must be a whole number"});
    return value;
  };
  const auto after = number("after");
  const int divisor = static_cast<int>(number("divisor").value_or(1));
  if (divisor != 1 && divisor != 2 && divisor != 4 && divisor != 8) {
    errors.push_back({"divisor", "must be 1, 2, 4 or 8"});
  }
  if (!errors.empty()) {
    return call->respond(
        problem({base::Code::Invalid, "there is no such picture", std::move(errors)}));
  }
  const base::PicturePtr picture = camera->newest();
  if (!picture) {
    return call->respond(problem({base::Code::Unavailable, "the camera gave no picture yet"}));
  }
  if (after && static_cast<std::int64_t>(picture->count) == *after) {
    Response response{http::status::no_content, 11};
    tell_picture(response, *picture);
    return call->respond(std::move(response));
  }
  if (divisor == 1 || !c->deps.cameras.smaller) {
    return call->respond(picture_response(*picture, picture->jpeg));
  }
  const Effort effort{Effort::kAtOnce + 1};
  c->answer_aside(call, effort, [c, picture, divisor] {
    const auto small = c->deps.cameras.smaller(*picture, divisor);
    return small ? picture_response(*picture, *small)
                 : problem({base::Code::Unavailable, small.error().detail});
  });
}

}  // namespace

void add_camera_routes(const ContextPtr& c) {
  const auto get = http::verb::get;
  c->router.add({get, "/cameras", {200, 503}, [c](const CallPtr& call) {
                   const auto s = c->snapshot_or_refuse(call);
                   if (!s) return;
                   Json items = Json::array();
                   for (const auto& camera : c->deps.cameras.cameras) {
                     items.push_back(camera_json(camera, *s));
                   }
                   call->respond(json_response(http::status::ok, {{"items", std::move(items)}}));
                 }});
  c->router.add(
      {get, "/cameras/{name}/snapshot", {200, 204, 404, 422, 503}, [c](const CallPtr& call) {
         answer_picture(c, call);
       }});
}

}  // namespace roverd::api
