// Things whose place is known: entered, changed, forgotten, and what became of them when they were
// seen.

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/context.hpp"
#include "api/json/measured.hpp"
#include "base/angle.hpp"

namespace roverd::api {

namespace {

using base::Code;
using base::KnownPlace;

const Effort kKeepPlaces{Effort::kAtOnce + 1, true};  // a disk may pause

bool is_place_name(std::string_view name) noexcept {
  const auto good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !name.empty() && name.size() <= 24 && std::ranges::all_of(name, good);
}

Json known_place_json(const KnownPlace& p, const base::KnownPlaceState* state, base::Time now) {
  Json out{
      {"name", p.name},
      {"tag", p.tag ? Json(*p.tag) : Json()},
      {"lat", p.at.lat},
      {"lon", p.at.lon},
      {"heading_deg", p.yaw_rad ? rounded(base::heading_from_yaw(*p.yaw_rad), kPlaces2) : Json()},
      {"accuracy_m", p.sigma_m},
      {"heading_accuracy_deg", degrees(p.yaw_sigma_rad)},
      {"configured", p.configured},
      {"state", "unseen"},
      {"off_m", nullptr},
      {"off_direction_deg", nullptr},
      {"sigma_m", nullptr},
      {"detail", nullptr},
      {"age_s", nullptr}};
  if (state == nullptr) return out;
  out["state"] = base::to_string(state->verdict);
  if (!state->detail.empty()) out["detail"] = state->detail;
  if (!state->seen_at) return out;
  out["age_s"] = rounded(std::max(0.0, base::seconds(now - *state->seen_at)), kPlaces2);
  if (state->sigma_m <= 0.0) return out;
  const base::EnuPoint& off = state->off;
  out["off_m"] = rounded(std::hypot(off.east_m, off.north_m), kPlaces3);
  out["off_direction_deg"] =
      rounded(base::heading_from_yaw(std::atan2(off.north_m, off.east_m)), kPlaces2);
  out["sigma_m"] = rounded(state->sigma_m, kPlaces3);
  return out;
}

Json one_json(const Context& context, const KnownPlace& place) {
  const auto s = context.deps.robot.snapshot();
  const base::KnownPlaceState* state = nullptr;
  if (s && s->known_places) {
    const auto at = std::ranges::find(*s->known_places, place.name, &base::KnownPlaceState::name);
    if (at != s->known_places->end()) state = &*at;
  }
  return known_place_json(place, state, base::steady_now());
}

/// Where it stands: lat and lon, or east_m and north_m in the robot's map.
void read_known_place(Members& m, const base::Snapshot* s, KnownPlace& out) {
  const auto lat = m.number("lat", -90.0, 90.0);
  const auto lon = m.number("lon", -180.0, 180.0);
  const auto east = m.number("east_m", -base::LocalFrame::kReach_m, base::LocalFrame::kReach_m);
  const auto north = m.number("north_m", -base::LocalFrame::kReach_m, base::LocalFrame::kReach_m);
  if (m.complained()) return;
  const bool global = lat || lon;
  const bool local = east || north;
  if (global && local) return m.complain("east_m", "and lat exclude each other: give one of them");
  if (!local && !(lat && lon)) {
    return m.complain(lat ? "lon" : "lat", "is required, or east_m and north_m");
  }
  if (global) {
    out.at = {*lat, *lon};
    return;
  }
  if (!(east && north)) return m.complain(east ? "north_m" : "east_m", "is required, too");
  if (s == nullptr || !s->frame) {
    return m.complain("east_m", "cannot be told yet: the robot has no map; give lat and lon");
  }
  out.at = s->frame->to_global({*east, *north});
}

base::Result<KnownPlace> known_place_from(const Json& json, const std::string& name,
                                          const base::Snapshot* s) {
  KnownPlace out;
  out.name = name;
  Members m(json);
  read_known_place(m, s, out);
  if (const auto tag = m.whole("tag", 0, 586)) out.tag = static_cast<int>(*tag);
  if (const auto deg = m.number("heading_deg", 0.0, 360.0)) {
    out.yaw_rad = base::yaw_from_heading(*deg);
    if (!out.tag) m.complain("heading_deg", "is of a tag; a pole looks nowhere");
  }
  out.sigma_m = m.number("accuracy_m", 0.01, 2.0).value_or(out.sigma_m);
  if (const auto deg = m.number("heading_accuracy_deg", 0.2, 45.0)) {
    out.yaw_sigma_rad = base::rad_from_deg(*deg);
  }
  if (auto good = m.finish(); !good) return tl::unexpected(good.error());
  return out;
}

/// In force at once; written down, and then told.
void take_places(const ContextPtr& context, const CallPtr& call, std::vector<KnownPlace> places,
                 std::function<Response()> answer) {
  context->known_places = std::move(places);
  auto list = std::make_shared<const std::vector<KnownPlace>>(context->known_places);
  context->deps.robot.know(list);
  context->answer_aside(
      call, kKeepPlaces,
      [keep = context->deps.known_places.keep, list, answer = std::move(answer)]() -> Response {
        if (const auto kept = keep(*list); !kept) {
          return problem({Code::Unavailable,
                          "it is so now, but not after a restart: " + kept.error().detail,
                          {}});
        }
        return answer();
      });
}

void put_place(const ContextPtr& context, const CallPtr& call) {
  const std::string& name = call->params.at("name");
  const auto wrong = [&call](Code code, const char* field, std::string why) {
    base::Error error{code, why, {}};
    if (field != nullptr) error.fields.push_back({field, std::move(why)});
    call->respond(problem(error));
  };
  if (!is_place_name(name)) {
    return wrong(Code::Invalid, "name", "name has a to z, 0 to 9 and _, 24 signs at most");
  }
  const auto json = json_body(call->request);
  if (!json) return call->respond(problem(json.error()));
  const auto snapshot = context->deps.robot.snapshot();
  const auto place = known_place_from(*json, name, snapshot.get());
  if (!place) return call->respond(problem(place.error()));
  std::vector<KnownPlace> next = context->known_places;
  const auto known = std::ranges::find(next, name, &KnownPlace::name);
  if (known != next.end() && known->configured) {
    return wrong(Code::Conflict, nullptr,
                 "the configuration says where " + name + " stands: change it there");
  }
  for (const KnownPlace& other : next) {
    if (place->tag && other.name != name && other.tag == place->tag) {
      return wrong(Code::Conflict, nullptr,
                   "tag " + std::to_string(*place->tag) + " is " + other.name + " already");
    }
  }
  if (known == next.end() && next.size() == base::kMostKnownPlaces) {
    return wrong(Code::Conflict, nullptr,
                 std::to_string(base::kMostKnownPlaces) + " are known; no more fit");
  }
  if (known != next.end()) {
    *known = *place;
  } else {
    next.push_back(*place);
  }
  take_places(context, call, std::move(next), [body = one_json(*context, *place)] {
    return json_response(http::status::ok, body);
  });
}

void forget_place(const ContextPtr& context, const CallPtr& call) {
  const std::string& name = call->params.at("name");
  std::vector<KnownPlace> next = context->known_places;
  const auto known = std::ranges::find(next, name, &KnownPlace::name);
  if (known == next.end()) {
    return call->respond(problem({Code::NotFound, "no place " + name + " is known", {}}));
  }
  if (known->configured) {
    return call->respond(problem(
        {Code::Conflict, "the configuration says where " + name + " stands: change it there", {}}));
  }
  next.erase(known);
  take_places(context, call, std::move(next), [] {
    return Response{http::status::no_content, 11};
  });
}

}  // namespace

void add_known_place_routes(const ContextPtr& c) {
  c->known_places = c->deps.known_places.begin;
  c->router.add({http::verb::get, "/known-places", {200, 503}, [c](const CallPtr& call) {
                   Json items = Json::array();
                   for (const KnownPlace& p : c->known_places) items.push_back(one_json(*c, p));
                   call->respond(json_response(http::status::ok, {{"items", std::move(items)}}));
                 }});
  if (!c->deps.known_places.keep) {
    c->deps.known_places.keep = [](const auto&) -> base::Result<void> { return {}; };
  }
  c->router.add({http::verb::put,
                 "/known-places/{name}",
                 {200, 400, 403, 409, 413, 415, 422, 503},
                 [c](const CallPtr& call) { put_place(c, call); }});
  c->router.add({http::verb::delete_,
                 "/known-places/{name}",
                 {204, 403, 404, 409, 503},
                 [c](const CallPtr& call) { forget_place(c, call); }});
}

}  // namespace roverd::api
