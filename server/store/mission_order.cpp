// Order among missions: names, tags, the archive, copies.

#include <algorithm>
#include <utility>

#include "store/mission_entry.hpp"

namespace roverd::store {

using base::Code;
using base::Error;
using base::Result;
using base::WallTime;

namespace {

Error wrong_member(const std::string& pointer, const std::string& detail) {
  return {Code::Invalid, pointer.substr(1) + " " + detail, {{pointer, detail}}};
}

/// Sorted, each once. Invalid, naming the member.
Result<std::vector<std::string>> good_tags(std::vector<std::string> tags) {
  if (tags.size() > kMaxTags) {
    return tl::unexpected<Error>(
        wrong_member("/tags", "has " + std::to_string(tags.size()) + ", at most 20 are possible"));
  }
  for (std::size_t i = 0; i < tags.size(); ++i) {
    std::string problem = mission::name_problem(tags[i]);
    if (problem.empty() && mission::utf8_length(tags[i]).value_or(0) > kMaxTagLength) {
      problem = "must have at most 60 characters";
    }
    if (problem.empty()) continue;
    return tl::unexpected<Error>(wrong_member("/tags/" + std::to_string(i), problem));
  }
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  return tags;
}

/// "renamed to x, tagged a b, archived"
std::string words_of(const Description& description) {
  std::string out;
  const auto add = [&out](const std::string& words) {
    if (!out.empty()) out += ", ";
    out += words;
  };
  if (description.name) add("renamed to " + *description.name);
  if (description.tags) {
    std::string tags;
    for (const std::string& tag : *description.tags) tags += (tags.empty() ? "" : " ") + tag;
    add(tags.empty() ? "untagged" : "tagged " + tags);
  }
  if (description.archived) add(*description.archived ? "archived" : "taken out of the archive");
  return out;
}

}  // namespace

Result<StoredMission> Missions::describe(const std::string& id, std::int64_t expected,
                                         const Description& description, const Change& change,
                                         WallTime now) {
  Description wanted = description;
  if (wanted.tags) {
    auto tags = good_tags(std::move(*wanted.tags));
    if (!tags) return tl::unexpected<Error>(tags.error());
    wanted.tags = std::move(*tags);
  }
  if (wanted.name) {
    if (std::string problem = mission::name_problem(*wanted.name); !problem.empty()) {
      return tl::unexpected<Error>(wrong_member("/name", problem));
    }
  }
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  auto found = live_head(id, expected);
  if (!found) return tl::unexpected<Error>(found.error());
  auto present = read_revision(id, found->revision);
  if (!present) return present;
  // What is so already is no change.
  if (wanted.name == present->plan.name) wanted.name.reset();
  if (wanted.tags == present->tags) wanted.tags.reset();
  if (wanted.archived == present->archived) wanted.archived.reset();
  if (!wanted.name && !wanted.tags && !wanted.archived) return present;
  if (wanted.name) present->plan.name = *wanted.name;
  Entry entry(change, words_of(wanted), now);
  entry.hold(present->plan);
  entry.tags = wanted.tags;
  found->archived = wanted.archived.value_or(found->archived);
  found->revision += 1;
  add_revision(*found, entry);
  transaction.commit();
  present->revision = found->revision;
  present->updated = now;
  present->archived = found->archived;
  if (wanted.tags) present->tags = *wanted.tags;
  return present;
}

Result<StoredMission> Missions::copy(const std::string& id, const std::optional<std::string>& name,
                                     const Change& change, WallTime now) {
  SQLite::Transaction transaction(db_, SQLite::TransactionBehavior::IMMEDIATE);
  auto original = read(id);
  if (!original) return original;
  Entry entry(change, "copied from " + original->plan.name, now);
  entry.tags = original->tags;
  original->plan.name = name ? *name : mission::name_with_ending(original->plan.name, " (copy)");
  auto made = add_mission(std::move(original->plan), entry);
  if (made) transaction.commit();
  return made;
}

}  // namespace roverd::store
