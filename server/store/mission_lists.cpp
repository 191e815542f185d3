// Lists: a page is read from an index, from where the page before ended.

#include <utility>

#include "mission/text.hpp"
#include "store/mission_entry.hpp"

namespace roverd::store {
namespace {

using base::Error;
using base::Result;

/// Written out for each case, because only then SQLite uses the partial indexes.
const char* condition_of(Which which) {
  switch (which) {
    case Which::Present:
      return "m.deleted = 0 AND m.archived = 0";
    case Which::Archived:
      return "m.deleted = 0 AND m.archived = 1";
    case Which::Deleted:
      break;
  }
  return "m.deleted = 1";
}

}  // namespace

Result<Below> below(const std::string& cursor) {
  Below out;
  if (cursor.empty()) return out;
  const std::size_t dot = cursor.find('.');
  const auto number = number_from(std::string_view(cursor).substr(0, dot));
  if (dot == std::string::npos || !number) return tl::unexpected<Error>(bad_cursor());
  out.updated_ns = *number;
  out.id = cursor.substr(dot + 1);
  return out;
}

std::string list_sql(const Filter& filter) {
  const bool tagged = !filter.tag.empty();
  const std::string of = tagged ? "t.updated_ns, t.mission_id" : "m.updated_ns, m.id";
  // A name is looked for in the index alone; the rows of the page are fetched afterwards.
  std::string found = "SELECT " + of + " FROM ";
  found += tagged ? "mission_tags t CROSS JOIN missions m ON m.id = t.mission_id WHERE t.tag = ?4 "
                    "AND "
                  : "missions m WHERE ";
  found += condition_of(filter.which);
  found += " AND (" + of + ") < (?1, ?2)";
  if (!filter.name.empty()) found += " AND instr(m.search, ?5) > 0";
  found += tagged ? " ORDER BY t.updated_ns DESC, t.mission_id DESC LIMIT ?3"
                  : " ORDER BY m.updated_ns DESC, m.id DESC LIMIT ?3";
  return "WITH found (updated_ns, id) AS MATERIALIZED (" + found +
         ") SELECT r.id, r.revision, r.name, r.items, r.length_m, r.updated_ns, r.archived "
         "FROM found CROSS JOIN missions r ON r.id = found.id "
         "ORDER BY found.updated_ns DESC, found.id DESC";
}

Result<Page<MissionSummary>> Missions::list(int limit, const std::string& cursor,
                                            const Filter& filter) {
  if (auto ok = check_limit(limit); !ok) return tl::unexpected<Error>(ok.error());
  const auto from = below(cursor);
  if (!from) return tl::unexpected<Error>(from.error());
  SQLite::Statement rows(db_, list_sql(filter));
  rows.bind(1, from->updated_ns);
  rows.bind(2, from->id);
  rows.bind(3, limit + 1);  // one more shows whether there is a next page
  if (!filter.tag.empty()) rows.bind(4, filter.tag);
  if (!filter.name.empty()) rows.bind(5, mission::folded(filter.name));
  SQLite::Statement tag_rows(db_, "SELECT tag FROM mission_tags WHERE mission_id = ? ORDER BY tag");
  Page<MissionSummary> page;
  std::int64_t last_ns = 0;
  while (rows.executeStep()) {
    if (static_cast<int>(page.items.size()) == limit) {
      page.next_cursor = std::to_string(last_ns) + '.' + page.items.back().id;
      break;
    }
    last_ns = rows.getColumn(5).getInt64();
    std::string id = rows.getColumn(0).getString();
    tag_rows.reset();
    tag_rows.bind(1, id);
    std::vector<std::string> tags;
    while (tag_rows.executeStep()) tags.push_back(tag_rows.getColumn(0).getString());
    page.items.push_back({std::move(id), rows.getColumn(1).getInt64(),
                          rows.getColumn(2).getString(), rows.getColumn(3).getInt(),
                          rows.getColumn(4).getDouble(), time_from(last_ns),
                          rows.getColumn(6).getInt() != 0, std::move(tags)});
  }
  return page;
}

Result<Page<TagCount>> Missions::list_tags(int limit, const std::string& cursor) {
  if (auto ok = check_limit(limit); !ok) return tl::unexpected<Error>(ok.error());
  SQLite::Statement rows(db_,
                         "SELECT t.tag, sum(m.archived = 0), sum(m.archived) "
                         "FROM mission_tags t CROSS JOIN missions m ON m.id = t.mission_id "
                         "WHERE t.tag > ? AND m.deleted = 0 GROUP BY t.tag ORDER BY t.tag LIMIT ?");
  rows.bind(1, cursor);
  rows.bind(2, limit + 1);
  Page<TagCount> page;
  while (rows.executeStep()) {
    if (static_cast<int>(page.items.size()) == limit) {
      page.next_cursor = page.items.back().tag;
      break;
    }
    page.items.push_back(
        {rows.getColumn(0).getString(), rows.getColumn(1).getInt(), rows.getColumn(2).getInt()});
  }
  return page;
}

Result<Page<RevisionSummary>> revision_page(SQLite::Statement& rows, const std::string& id,
                                            int limit, const std::string& cursor) {
  if (auto ok = check_limit(limit); !ok) return tl::unexpected<Error>(ok.error());
  const auto before = below_number(cursor);
  if (!before) return tl::unexpected<Error>(before.error());
  rows.bind(1, id);
  rows.bind(2, *before);
  rows.bind(3, limit + 1);
  Page<RevisionSummary> page;
  while (rows.executeStep()) {
    if (static_cast<int>(page.items.size()) == limit) {
      page.next_cursor = std::to_string(page.items.back().revision);
      break;
    }
    page.items.push_back({rows.getColumn(0).getInt64(), time_from(rows.getColumn(1).getInt64()),
                          rows.getColumn(2).getString(), rows.getColumn(3).getString(),
                          rows.getColumn(4).getInt() != 0, rows.getColumn(5).getString(),
                          rows.getColumn(6).getInt(), rows.getColumn(7).getDouble()});
  }
  return page;
}

Result<Page<RevisionSummary>> Missions::list_revisions(const std::string& id, int limit,
                                                       const std::string& cursor) {
  if (const auto known = head(id); !known) return tl::unexpected<Error>(known.error());
  SQLite::Statement rows(
      db_,
      "SELECT revision, time_ns, author, what, plan IS NULL AND packed IS NULL, name, items, "
      "length_m FROM revisions WHERE mission_id = ? AND revision < ? "
      "ORDER BY revision DESC LIMIT ?");
  return revision_page(rows, id, limit, cursor);
}

}  // namespace roverd::store
