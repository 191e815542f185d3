// The text of a node map to a graph, with everything that is wrong in it.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <unordered_map>

#include "mission/formats/text_lines.hpp"
#include "mission/graph/route_graph.hpp"
#include "mission/json/pointer.hpp"
#include "mission/text.hpp"

namespace roverd::mission {
namespace {

constexpr double kFar_m = 10'000.0;
constexpr double kMostTurns_rad = 100.0;
constexpr std::size_t kMostNotes = 100;

std::vector<std::string_view> tokens_of(std::string_view line) {
  std::vector<std::string_view> out;
  constexpr std::string_view kBlank = " \t\v\f";
  for (std::size_t at = line.find_first_not_of(kBlank); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlank, at), line.size());
    out.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlank, end);
  }
  return out;
}

bool same_word(std::string_view token, std::string_view word) {
  return token.size() == word.size() &&
         std::equal(token.begin(), token.end(), word.begin(), [](char a, char b) {
           return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
         });
}

template <class N>
std::optional<N> value_in(std::string_view text) {
  N value{};
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (ec != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The values of one line.
struct Record {
  bool home = false;
  std::optional<std::int64_t> id;
  std::vector<double> pose;
  std::vector<double> latlon;
  std::vector<std::int64_t> links;
};

class GraphReader {
 public:
  base::Result<ReadGraph> read(std::string_view text) {
    TextLines lines(without_bom(text));
    for (std::string_view line; lines.next(line);) {
      ++line_;
      const auto tokens = tokens_of(line);
      if (tokens.empty() || tokens.front().starts_with('#')) continue;
      take_line(tokens);
      if (nodes_.size() > kMaxMapNodes || links_ > kMaxMapLinks) {
        return base::fail(base::Code::TooLarge, "more than " + std::to_string(kMaxMapNodes) +
                                                    " nodes or " + std::to_string(kMaxMapLinks) +
                                                    " links");
      }
    }
    if (nodes_.empty() && problems_.none()) problems_.add("line 1", "no node in the whole text");
    connect();
    if (!problems_.none()) {
      return tl::unexpected<base::Error>(std::move(problems_).error("the map"));
    }
    look_for_islands();
    std::stable_sort(out_.notes.begin(), out_.notes.end(),
                     [](const MapNote& a, const MapNote& b) { return a.line < b.line; });
    if (out_.notes.size() > kMostNotes) out_.notes.resize(kMostNotes);
    return std::move(out_);
  }

 private:
  struct Found {
    MapNode node;
    std::size_t line = 0;
  };

  std::string here() const { return "line " + std::to_string(line_); }
  void note(std::size_t line, std::string detail) {
    // Some more than are kept: they are sorted by line before the rest is dropped.
    if (out_.notes.size() < 100 * kMostNotes) out_.notes.push_back({line, std::move(detail)});
  }

  void take_line(const std::vector<std::string_view>& tokens) {
    Record record;
    record.home = same_word(tokens[0], "home") || same_word(tokens[0], "homenode");
    if (!record.home && !same_word(tokens[0], "node")) {
      return note(line_, "passed over: it begins with neither Node nor Home");
    }
    if (!read_values(tokens, record)) return;
    if (!record.id) return problems_.add(here(), "has no id");
    if (record.home) {
      if (home_line_ != 0) {
        return problems_.add(
            here(), "names a second home; the first one is on line " + std::to_string(home_line_));
      }
      out_.graph.home = record.id;
      home_line_ = line_;
      if (record.pose.empty() && record.latlon.empty() && record.links.empty()) return;
    }
    add_node(record);
  }

  /// key=value value … ~
  bool read_values(const std::vector<std::string_view>& tokens, Record& record) {
    std::string_view key;
    for (std::size_t i = 1; i < tokens.size(); ++i) {
      std::string_view value = tokens[i];
      if (value == "~") {
        if (i + 1 == tokens.size()) return true;
        return damaged("goes on after its ~");
      }
      if (const std::size_t sign = value.find('='); sign != std::string_view::npos) {
        key = value.substr(0, sign);
        value.remove_prefix(sign + 1);
        const bool again = (same_word(key, "id") && record.id) ||
                           (same_word(key, "pose") && !record.pose.empty()) ||
                           (same_word(key, "latlon") && !record.latlon.empty()) ||
                           (same_word(key, "links") && !record.links.empty());
        if (again) return damaged("has " + clean_name(key, "a key") + " twice");
        if (value.empty()) continue;
      }
      if (!take_value(key, value, record)) return false;
    }
    note(line_, "has no ~ at its end");
    return true;
  }

  bool take_value(std::string_view key, std::string_view value, Record& record) {
    const bool on_earth = same_word(key, "latlon");
    if (on_earth || same_word(key, "pose")) {
      const auto number = value_in<double>(value);
      if (!number || !std::isfinite(*number)) return damaged_value(key, value);
      (on_earth ? record.latlon : record.pose).push_back(*number);
      return true;
    }
    const bool is_id = same_word(key, "id");
    if (!is_id && !same_word(key, "links")) {
      return key.empty() ? damaged("has \"" + clean_name(value, "?") + "\" without a key") : true;
    }
    const auto number = value_in<std::int64_t>(value);
    if (!number || (is_id && record.id)) return damaged_value(key, value);
    if (is_id) {
      record.id = number;
    } else {
      record.links.push_back(*number);
    }
    return true;
  }

  bool damaged(std::string detail) {
    problems_.add(here(), std::move(detail));
    return false;
  }
  bool damaged_value(std::string_view key, std::string_view value) {
    return damaged(clean_name(key, "a key") + " cannot be \"" + clean_name(value, "?") + "\"");
  }

  void add_node(const Record& record) {
    if (!record.latlon.empty() && record.pose.empty()) return add_node_on_earth(record);
    if (!record.latlon.empty()) return problems_.add(here(), "has both a pose and a latlon");
    constexpr std::size_t kPose = 3;
    if (record.pose.size() != kPose) {
      return problems_.add(here(), "pose must be x, y and theta, has " +
                                       std::to_string(record.pose.size()) + " numbers");
    }
    if (std::abs(record.pose[0]) > kFar_m || std::abs(record.pose[1]) > kFar_m) {
      return problems_.add(here(), "pose lies more than 10 km from the origin");
    }
    if (std::abs(record.pose[2]) > kMostTurns_rad) {
      return problems_.add(here(), "theta must be an angle in radians");
    }
    keep(record, {*record.id, record.pose[0], record.pose[1], record.pose[2], record.links});
  }

  void add_node_on_earth(const Record& record) {
    constexpr std::size_t kLatLon = 2;
    if (record.latlon.size() != kLatLon) {
      return problems_.add(here(), "latlon must be latitude and longitude, has " +
                                       std::to_string(record.latlon.size()) + " numbers");
    }
    const LatLon at{record.latlon[0], record.latlon[1]};
    if (!base::is_valid(at)) {
      return problems_.add(here(), "latlon is no latitude and longitude in degrees");
    }
    keep(record, {*record.id, 0.0, 0.0, 0.0, record.links, at});
  }

  void keep(const Record& record, MapNode node) {
    const auto [at, is_new] = index_.try_emplace(*record.id, nodes_.size());
    if (!is_new) {
      return problems_.add(here(), "node " + std::to_string(*record.id) + " is on line " +
                                       std::to_string(nodes_[at->second].line) + " already");
    }
    links_ += record.links.size();
    nodes_.push_back({std::move(node), line_});
  }

  /// Links to nodes that are there, each once.
  void connect() {
    if (home_line_ != 0 && !index_.contains(*out_.graph.home)) {
      problems_.add(
          "line " + std::to_string(home_line_),
          "names the home node " + std::to_string(*out_.graph.home) + ", which is not there");
    }
    for (Found& found : nodes_) {
      auto& links = found.node.links;
      std::sort(links.begin(), links.end());
      if (const auto end = std::unique(links.begin(), links.end()); end != links.end()) {
        note(found.line, "names a link twice");
        links.erase(end, links.end());
      }
      if (std::erase(links, found.node.id) > 0) note(found.line, "is linked to itself");
      for (const std::int64_t to : links) {
        if (index_.contains(to)) continue;
        problems_.add("line " + std::to_string(found.line),
                      "is linked to node " + std::to_string(to) + ", which is not there");
      }
    }
    if (!problems_.none()) return;
    for (const Found& found : nodes_) {
      for (const std::int64_t to : found.node.links) {
        const auto& back = nodes_[index_.at(to)].node.links;
        if (std::binary_search(back.begin(), back.end(), found.node.id)) continue;
        note(found.line, "the link to node " + std::to_string(to) + " leads there only");
      }
    }
    for (Found& found : nodes_) out_.graph.nodes.push_back(found.node);
    std::sort(out_.graph.nodes.begin(), out_.graph.nodes.end(),
              [](const MapNode& a, const MapNode& b) { return a.id < b.id; });
  }

  /// Parts that no link joins, whichever way it leads.
  void look_for_islands() {
    std::vector<std::size_t> root(nodes_.size());
    for (std::size_t i = 0; i < root.size(); ++i) root[i] = i;
    const auto find = [&root](std::size_t i) {
      while (root[i] != i) i = root[i] = root[root[i]];
      return i;
    };
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      for (const std::int64_t to : nodes_[i].node.links) root[find(index_.at(to))] = find(i);
    }
    std::unordered_map<std::size_t, std::size_t> sizes;
    for (std::size_t i = 0; i < root.size(); ++i) ++sizes[find(i)];
    if (sizes.size() < 2) return;
    const std::size_t main = find(out_.graph.home ? index_.at(*out_.graph.home) : 0);
    std::unordered_map<std::size_t, bool> told;
    for (std::size_t i = 0; i < root.size(); ++i) {
      const std::size_t part = find(i);
      if (part == main || std::exchange(told[part], true)) continue;
      note(nodes_[i].line, "node " + std::to_string(nodes_[i].node.id) + " belongs to a part of " +
                               std::to_string(sizes[part]) + " that no link joins to the rest");
    }
  }

  std::size_t line_ = 0;
  std::size_t home_line_ = 0;  ///< 0: none
  std::size_t links_ = 0;
  std::vector<Found> nodes_;
  std::unordered_map<std::int64_t, std::size_t> index_;
  Problems problems_;
  ReadGraph out_;
};

}  // namespace

base::Result<ReadGraph> graph_from_text(std::string_view text) {
  return GraphReader().read(text);
}

}  // namespace roverd::mission
