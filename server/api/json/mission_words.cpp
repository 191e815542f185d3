#include <algorithm>

#include "api/body.hpp"
#include "api/json/words.hpp"
#include "mission/edit/compare.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

template <class T, class F>
Json page_json(const store::Page<T>& page, F&& one) {
  Json items = Json::array();
  for (const T& item : page.items) items.push_back(one(item));
  return {{"items", std::move(items)},
          {"next_cursor", page.next_cursor ? Json(*page.next_cursor) : Json(nullptr)}};
}

}  // namespace

std::string etag_of(std::int64_t revision) {
  return "\"rev-" + std::to_string(revision) + "\"";
}

std::optional<std::int64_t> revision_of(std::string_view etag) noexcept {
  constexpr std::string_view kBegin = "\"rev-";
  if (!etag.starts_with(kBegin) || !etag.ends_with('"')) return std::nullopt;
  const std::string_view digits = etag.substr(kBegin.size(), etag.size() - kBegin.size() - 1);
  // As etag_of writes it and no other way: no sign and no zero before it.
  if (digits.empty() || digits.front() < '1' || digits.front() > '9') return std::nullopt;
  return whole_number(digits);
}

Json mission_json(const store::StoredMission& mission) {
  Json out = mission::plan_to_json(mission.plan);
  if (!out.contains("home")) out["home"] = nullptr;
  out["id"] = mission.id;
  out["revision"] = mission.revision;
  out["created"] = base::to_rfc3339(mission.created);
  out["updated"] = base::to_rfc3339(mission.updated);
  out["length_m"] = mission::length_m(mission.plan);
  out["archived"] = mission.archived;
  out["tags"] = mission.tags;
  return out;
}

Json mission_list_json(const store::Page<store::MissionSummary>& page) {
  return page_json(page, [](const store::MissionSummary& m) -> Json {
    return {{"id", m.id},
            {"revision", m.revision},
            {"name", m.name},
            {"items", m.items},
            {"length_m", m.length_m},
            {"updated", base::to_rfc3339(m.updated)},
            {"archived", m.archived},
            {"tags", m.tags}};
  });
}

Json deleted_list_json(const store::Page<store::MissionSummary>& page) {
  Json out = mission_list_json(page);
  for (Json& one : out["items"]) one["deleted_at"] = one["updated"];
  return out;
}

namespace {

/// {from, to}, or null where nothing changed.
Json both_json(bool differ, Json from, Json to) {
  return differ ? Json{{"from", std::move(from)}, {"to", std::move(to)}} : Json(nullptr);
}

Json item_of(const mission::Plan& plan, const std::optional<int>& number) {
  if (!number) return nullptr;
  return mission::item_to_json(plan.items.at(static_cast<std::size_t>(*number) - 1));
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

}  // namespace

Json differences_json(const store::StoredMission& older, const store::StoredMission& newer) {
  const mission::Differences found = mission::compare(older.plan, newer.plan);
  const Json from = mission::plan_to_json(older.plan);
  const Json to = mission::plan_to_json(newer.plan);
  Json items = Json::array();
  for (const mission::ItemDifference& d : found.items) {
    items.push_back({{"change", mission::to_string(d.change)},
                     {"from_item", or_null(d.before)},
                     {"to_item", or_null(d.now)},
                     {"from", item_of(older.plan, d.before)},
                     {"to", item_of(newer.plan, d.now)},
                     {"moved_m", or_null(d.moved_m)}});
  }
  return {{"from", older.revision},
          {"to", newer.revision},
          {"name", both_json(found.name, from["name"], to["name"])},
          {"home", both_json(found.home, from.value("home", Json()), to.value("home", Json()))},
          {"settings", both_json(found.settings, from["settings"], to["settings"])},
          {"frame", both_json(found.frame, from.value("frame", Json(nullptr)),
                              to.value("frame", Json(nullptr)))},
          {"length_m",
           {{"from", mission::length_m(older.plan)}, {"to", mission::length_m(newer.plan)}}},
          {"added", found.added},
          {"removed", found.removed},
          {"changed", found.changed},
          {"unchanged", found.unchanged},
          {"items", std::move(items)}};
}

Json revision_list_json(const store::Page<store::RevisionSummary>& page) {
  return page_json(page, [](const store::RevisionSummary& r) -> Json {
    return {{"revision", r.revision}, {"time", base::to_rfc3339(r.time)},
            {"author", r.author},     {"what", r.what},
            {"deletion", r.deletion}, {"name", r.name},
            {"items", r.items},       {"length_m", r.length_m}};
  });
}

Json tag_list_json(const store::Page<store::TagCount>& page) {
  return page_json(page, [](const store::TagCount& t) -> Json {
    return {{"tag", t.tag}, {"missions", t.missions}, {"archived", t.archived}};
  });
}

namespace {

/// Most texts of an account need no escapes.
void append_quoted(std::string& out, std::string_view text) {
  const bool plain = std::all_of(text.begin(), text.end(), [](char c) {
    return c >= 0x20 && c < 0x7F && c != '"' && c != '\\';
  });
  if (!plain) {
    out += Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
    return;
  }
  out += '"';
  out += text;
  out += '"';
}

void append_row(std::string& out, const mission::FileRow& row) {
  out += "{\"row\":";
  append_quoted(out, row.row);
  out += ",\"what\":";
  append_quoted(out, row.what);
  out += ",\"outcome\":\"";
  out += mission::to_string(row.outcome);
  out += "\",\"item\":" + (row.item ? std::to_string(*row.item) : "null");
  out += ",\"mission\":" + (row.item ? std::to_string(row.mission) : "null");
  out += ",\"reason\":";
  append_quoted(out, row.reason);
  out += '}';
}

/// As POST /missions/survey takes it.
Json area_json(const mission::FieldArea& area) {
  Json rings = Json::array();
  for (const auto& points : area.rings) {
    Json ring = Json::array();
    for (const base::LatLon at : points) ring.push_back({at.lon, at.lat});
    if (!points.empty()) ring.push_back({points.front().lon, points.front().lat});
    rings.push_back(std::move(ring));
  }
  return {{"name", area.name},
          {"row", area.row},
          {"polygon", {{"type", "Polygon"}, {"coordinates", std::move(rings)}}}};
}

Json kept_json(const store::StoredMission& mission) {
  return {{"id", mission.id},
          {"revision", mission.revision},
          {"name", mission.plan.name},
          {"items", mission.plan.items.size()},
          {"length_m", mission::length_m(mission.plan)},
          {"updated", base::to_rfc3339(mission.updated)}};
}

}  // namespace

std::string import_text(const mission::ImportedFile& file, const store::StoredImport& kept) {
  Json head = {{"format", mission::to_string(file.format)},
               {"mission", nullptr},
               {"missions", Json::array()},
               {"fence_id", kept.fence ? Json(kept.fence->id) : Json(nullptr)},
               {"areas", Json::array()}};
  if (!kept.missions.empty()) head["mission"] = mission_json(kept.missions.front());
  for (const auto& mission : kept.missions) head["missions"].push_back(kept_json(mission));
  for (const auto& area : file.areas) head["areas"].push_back(area_json(area));
  for (const auto outcome :
       {mission::Outcome::Taken, mission::Outcome::Changed, mission::Outcome::LeftOut}) {
    head[std::string(mission::to_string(outcome))] =
        std::count_if(file.rows.begin(), file.rows.end(),
                      [outcome](const auto& row) { return row.outcome == outcome; });
  }
  std::string out = head.dump();
  out.pop_back();  // the brace
  out += ",\"report\":[";
  for (const mission::FileRow& row : file.rows) {
    append_row(out, row);
    out += ',';
  }
  if (!file.rows.empty()) out.pop_back();
  out += "]}";
  return out;
}

Json event_json(const store::StoredEvent& stored) {
  return {{"id", stored.id},
          {"time", base::to_rfc3339(stored.event.wall)},
          {"level", base::to_string(stored.event.level)},
          {"kind", stored.event.kind},
          {"detail", stored.event.detail}};
}

}  // namespace roverd::api
