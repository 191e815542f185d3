// Each map has a name of its own: missions count from a map by its name.

#include <map>
#include <string>

#include "maps/shelf.hpp"

namespace roverd::maps {

namespace {

/// "hall 2", cut where it would be longer than a name may be; between two characters.
std::string numbered(std::string name, int n) {
  constexpr std::size_t kLongest = 190;
  if (name.size() > kLongest) {
    std::size_t end = kLongest;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) --end;
    name.resize(end);
  }
  return name + " " + std::to_string(n);
}

std::string map_in_words(std::int64_t id) {
  return id == kConfigured ? "that of the configuration" : "map " + std::to_string(id);
}

}  // namespace

/// Which one keeps a name that several have: that of the configuration, whose file
/// says it; else the one in use, by which missions are driven; else the first.
void Shelf::part_names() {
  std::map<std::string, std::int64_t> keeps;
  for (const auto& [id, kept] : maps_) {
    const auto [at, first] = keeps.emplace(kept.about.name, id);
    if (!first && in_use_ == id && at->second != kConfigured) at->second = id;
  }
  for (const auto& [id, kept] : maps_) {
    const std::int64_t keeper = keeps.at(kept.about.name);
    if (keeper != id) call_otherwise(id, keeper);
  }
}

/// Also where that cannot be written down: then it is once more with the next start.
void Shelf::call_otherwise(std::int64_t id, std::int64_t namesake) {
  Kept& kept = maps_.at(id);
  const std::string before = kept.about.name;
  kept.about.name = free_name(before);
  ++kept.about.revision;
  troubles_.push_back("map " + std::to_string(id) + " is called \"" + kept.about.name +
                      "\" now: missions count from a map by its name, and \"" + before + "\" is " +
                      map_in_words(namesake));
  if (const auto done = write_about(id, kept); !done) {
    troubles_.push_back("map " + std::to_string(id) + ": " + done.error().detail);
  }
}

/// @return the map of that name, but not that one
std::optional<std::int64_t> Shelf::namesake_of(const std::string& name, std::int64_t but) const {
  const std::lock_guard lock(index_);
  for (const auto& [id, kept] : maps_) {
    if (id != but && kept.about.name == name) return id;
  }
  return std::nullopt;
}

base::Result<void> Shelf::is_free(const std::string& name) const {
  return is_free(name, kNoMap);
}

base::Result<void> Shelf::is_free(const std::string& name, std::int64_t but) const {
  const auto other = namesake_of(name, but);
  if (!other) return {};
  const std::string whose = map_in_words(*other);
  return base::fail(
      base::Code::Conflict,
      "the name \"" + name + "\" is taken by " + whose + ": give another one, or rename that map",
      {{"/name", "is taken by " + whose}});
}

/// "hall", "hall 2", …
std::string Shelf::free_name(const std::string& wanted) const {
  std::string name = wanted;
  for (int n = 2; namesake_of(name); ++n) name = numbered(wanted, n);
  return name;
}

}  // namespace roverd::maps
