// POST /missions/rows: a block of rows, as an answer or as a stored mission.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/body.hpp"
#include "api/context.hpp"
#include "api/mission_change.hpp"
#include "base/angle.hpp"
#include "mission/json/fields.hpp"
#include "mission/json/json.hpp"
#include "mission/rows/block.hpp"
#include "mission/rows/lies.hpp"
#include "mission/text.hpp"

namespace roverd::mission {

template <>
inline constexpr std::array kWordsOf<RowTurn>{RowTurn::Auto, RowTurn::Pivot, RowTurn::Arc,
                                              RowTurn::Omega, RowTurn::Shunt};

}  // namespace roverd::mission

namespace roverd::api {

namespace {

using mission::RowBlock;
using mission::RowTurn;

struct RowsOrder {
  RowBlock block;
  std::optional<std::string> name;  ///< to be stored under
};

void read_entry(Members& members, RowBlock& block) {
  const Json* value = members.any("entry");
  if (value == nullptr) return;
  if (!value->is_object()) return members.complain("entry", "must be {lat, lon}, degrees");
  Members point(*value);
  for (const char* name : {"lat", "lon"}) point.require(name);
  const auto lat = point.number("lat", -90.0, 90.0);
  const auto lon = point.number("lon", -180.0, 180.0);
  if (auto fine = point.finish(); !fine) return members.complain_inside("entry", fine.error());
  block.entry = base::LatLon{*lat, *lon};
}

/// Places of `block`; empty: none, or wrong.
std::vector<base::LatLon> read_corners(Members& members) {
  const Json* value = members.any("block");
  if (value == nullptr) return {};
  if (!value->is_array() || value->size() < 2 || value->size() > mission::kMostCorners) {
    members.complain("block", "must be a list of 2 to 100 places {lat, lon}");
    return {};
  }
  for (const char* other : {"entry", "heading_deg"}) {
    if (members.any(other) != nullptr) members.complain(other, "is told by the block");
  }
  std::vector<base::LatLon> out;
  base::Error wrong;
  for (std::size_t i = 0; i < value->size(); ++i) {
    const std::string at = "/" + std::to_string(i);
    if (!value->at(i).is_object()) {
      wrong.fields.push_back({at, "must be {lat, lon}, degrees"});
      continue;
    }
    Members point(value->at(i), at);
    for (const char* name : {"lat", "lon"}) point.require(name);
    const auto lat = point.number("lat", -90.0, 90.0);
    const auto lon = point.number("lon", -180.0, 180.0);
    auto fine = point.finish();
    if (fine) out.push_back({*lat, *lon});
    if (!fine)
      wrong.fields.insert(wrong.fields.end(), fine.error().fields.begin(),
                          fine.error().fields.end());
  }
  members.complain_inside("block", wrong);
  return out;
}

/// The block begins where it was drawn.
void begin_there(RowBlock& block, mission::LaidRows lies) {
  block.rows = static_cast<int>(lies.lanes.size());
  block.turn = lies.turn;
  block.entry = lies.lanes.front()[0];
  block.heading_deg = lies.heading_deg;
  block.lanes = std::move(lies.lanes);
}

base::Result<RowsOrder> read_rows(const Json& body) {
  RowsOrder order;
  RowBlock& b = order.block;
  Members members(body);
  members.require("spacing_m");
  if (members.any("block") == nullptr) members.require("rows");
  const auto rows = members.whole("rows", 1, mission::kMostRows);
  b.rows = static_cast<int>(rows.value_or(1));
  b.spacing_m = members.number("spacing_m", 0.3, 50.0).value_or(b.spacing_m);
  const bool says_turn = members.any("turn") != nullptr;
  members.word_or("turn", b.turn, mission::Side::Right);
  members.word_or("turn_kind", b.turn_kind, RowTurn::Auto);
  members.number("radius_m", b.radius_m, mission::kArc_m);
  b.alternating = members.flag("alternating").value_or(true);
  b.skip = static_cast<int>(members.whole("skip", 0, 20).value_or(0));
  b.out_m = members.number("out_m", 0.1, mission::kFarthestOut_m).value_or(b.out_m);
  read_entry(members, b);
  members.number("heading_deg", b.heading_deg, mission::kHeading_deg);
  members.word_or("side", b.row.side, mission::RowSide::Both);
  members.number("gap_m", b.row.gap_m, mission::kBeside_m);
  members.number("speed_mps", b.row.speed_mps, mission::kSpeed_mps);
  members.number("distance_m", b.row.distance_m, mission::kRow_m);
  members.word_or("seeing", b.row.seeing, mission::RowSeeing::Line);
  order.name = members.text("name");
  if (order.name) {
    if (auto problem = mission::name_problem(*order.name); !problem.empty()) {
      members.complain("name", std::move(problem));
    }
  }
  auto corners = read_corners(members);
  if (auto fine = members.finish(); !fine) return tl::unexpected<base::Error>(fine.error());
  if (!corners.empty()) {
    mission::BlockPlaces places{std::move(corners), b.spacing_m, {}, {}};
    if (rows) places.rows = b.rows;
    if (says_turn) places.turn = b.turn;
    auto lies = mission::lay_rows(places);
    if (!lies) return tl::unexpected<base::Error>(std::move(lies.error()));
    begin_there(b, std::move(*lies));
  }
  return order;
}

void answer_rows(const ContextPtr& context, const CallPtr& call) {
  const auto body = json_body(call->request);
  if (!body) return call->respond(problem(body.error()));
  auto order = read_rows(*body);
  if (!order) return call->respond(problem(order.error()));
  auto rows = mission::plan_rows(order->block, context->profile().turning);
  if (!rows) return call->respond(problem(rows.error()));
  mission::Plan plan;
  plan.name = order->name.value_or("Rows");
  plan.items = std::move(rows->items);
  auto figures = std::make_shared<Json>(
      Json{{"order", mission::order_of(order->block)}, {"headland_m", rows->headland_m}});
  if (!order->name) {
    (*figures)["mission"] = mission::plan_to_json(plan);
    return call->respond(json_response(http::status::ok, *figures));
  }
  context->deps.store.create_mission(
      std::move(plan), {kAuthor, "planned as a block of rows"},
      [context, call, figures](base::Result<store::StoredMission> stored) {
        if (!stored) return call->respond(problem(stored.error()));
        context->announce(stored->id, stored->revision);
        Response response = mission_response(http::status::created, *stored);
        (*figures)["mission"] = mission_json(*stored);
        response.body() = json_response(http::status::created, *figures).body();
        call->respond(std::move(response));
      });
}

}  // namespace

void add_rows_routes(const ContextPtr& c) {
  c->router.add({http::verb::post,
                 "/missions/rows",
                 {200, 201, 400, 403, 409, 413, 415, 422, 429, 503},
                 [c](const CallPtr& call) { answer_rows(c, call); }});
}

}  // namespace roverd::api
