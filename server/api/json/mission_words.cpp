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
  if (digits.starts_with('0')) return std::nullopt;
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

Json import_json(const mission::ImportedFile& file, const store::StoredMission& mission) {
  Json report = Json::array();
  const auto count = [&file](mission::Outcome outcome) {
    return std::count_if(file.rows.begin(), file.rows.end(),
                         [outcome](const auto& row) { return row.outcome == outcome; });
  };
  for (const mission::FileRow& row : file.rows) {
    report.push_back({{"row", row.row},
                      {"what", row.what},
                      {"outcome", mission::to_string(row.outcome)},
                      {"item", row.item ? Json(*row.item) : Json(nullptr)},
                      {"reason", row.reason}});
  }
  return {
      {"format", mission::to_string(file.format)},    {"mission", mission_json(mission)},
      {"taken", count(mission::Outcome::Taken)},      {"changed", count(mission::Outcome::Changed)},
      {"left_out", count(mission::Outcome::LeftOut)}, {"report", std::move(report)}};
}

Json event_json(const store::StoredEvent& stored) {
  return {{"id", stored.id},
          {"time", base::to_rfc3339(stored.event.wall)},
          {"level", base::to_string(stored.event.level)},
          {"kind", stored.event.kind},
          {"detail", stored.event.detail}};
}

}  // namespace roverd::api
