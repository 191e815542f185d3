#include <algorithm>

#include "api/body.hpp"
#include "api/words.hpp"
#include "mission/json.hpp"

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
  return out;
}

Json mission_list_json(const store::Page<store::MissionSummary>& page) {
  return page_json(page, [](const store::MissionSummary& m) -> Json {
    return {{"id", m.id},       {"revision", m.revision}, {"name", m.name},
            {"items", m.items}, {"length_m", m.length_m}, {"updated", base::to_rfc3339(m.updated)}};
  });
}

Json revision_list_json(const store::Page<store::RevisionSummary>& page) {
  return page_json(page, [](const store::RevisionSummary& r) -> Json {
    return {{"revision", r.revision}, {"time", base::to_rfc3339(r.time)},
            {"author", r.author},     {"what", r.what},
            {"deletion", r.deletion}, {"name", r.name},
            {"items", r.items},       {"length_m", r.length_m}};
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
