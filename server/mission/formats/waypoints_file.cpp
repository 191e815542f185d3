// QGC WPL 110: a head line, then one command a line, twelve columns apart by tabs or blanks:
//   number  current  frame  command  p1 p2 p3 p4  latitude longitude altitude  autocontinue
// ArduPilot keeps home in row 0; others begin with the first command there, and files of fences and
// rally points with those. So row 0 is home if it is written as one (is_home_command).
// Source: MAVLink developer guide, "plain-text file format"; Mission Planner's files.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "mission/formats/commands.hpp"
#include "mission/formats/file_formats.hpp"
#include "mission/formats/text_lines.hpp"
#include "mission/formats/track_points.hpp"
#include "mission/json/json.hpp"
#include "mission/text.hpp"

namespace roverd::mission {
namespace {

using base::Code;
using base::Error;
using base::Result;

constexpr std::string_view kHead = "QGC WPL 110";
constexpr std::size_t kColumns = 12;
constexpr std::array<const char*, kColumns> kColumnNames{
    "number",      "current",     "frame",    "command",   "parameter 1", "parameter 2",
    "parameter 3", "parameter 4", "latitude", "longitude", "altitude",    "autocontinue"};
constexpr int kDecimals = 8;

/// @return number of columns, also of those beyond the twelfth.
std::size_t split(std::string_view line, std::array<std::string_view, kColumns>& columns) {
  std::size_t count = 0;
  for (;;) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return count;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    if (count < kColumns) columns[count] = line.substr(0, end);
    ++count;
    line.remove_prefix(end);
  }
}

bool is_printable(std::string_view text) {
  for (const char c : text) {
    if (c < 0x20 || c > 0x7E) return false;
  }
  return true;
}

class RowReader {
 public:
  RowReader(std::string place, Problems& problems)
      : place_(std::move(place)), problems_(problems) {}

  /// Empty after a problem was noted.
  std::optional<Command> read(std::string_view line) {
    const std::size_t count = split(line, columns_);
    if (count != kColumns) {
      problems_.add(place_, "must have 12 columns, has " + std::to_string(count));
      return std::nullopt;
    }
    Command c;
    c.row = place_;
    c.number = whole(0);
    number(1);
    c.frame = whole(2);
    c.id = whole(3);
    for (std::size_t i = 0; i < c.p.size(); ++i) c.p[i] = number(4 + i);
    c.lat = number(8);
    c.lon = number(9);
    c.alt = number(10);
    c.auto_continue = number(11).value_or(1.0) != 0.0;
    if (failed_) return std::nullopt;
    return c;
  }

 private:
  void fail(std::size_t column, const std::string& what) {
    failed_ = true;
    constexpr std::size_t kMax = 40;
    const std::string_view shown = columns_[column].substr(0, kMax);
    std::string detail = std::string(kColumnNames[column]) + ' ' + what;
    if (is_printable(shown)) detail += ", is \"" + std::string(shown) + '"';
    problems_.add(place_, std::move(detail));
  }

  /// NaN is "not given"; for a latitude and longitude the caller refuses that.
  std::optional<double> number(std::size_t column) {
    std::string_view text = columns_[column];
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0;
    const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (ec == std::errc::result_out_of_range) {
      fail(column, "must be a number that fits a double");
    } else if (ec != std::errc{} || end != text.data() + text.size()) {
      fail(column, "must be a number");
    } else if (std::isinf(value)) {
      fail(column, "must be finite");
    } else if (!std::isnan(value)) {
      return value;
    }
    return std::nullopt;
  }

  /// Some programs write whole numbers as 16.000000.
  int whole(std::size_t column) {
    constexpr double kMost = 1e9;
    const auto value = number(column);
    if (failed_) return 0;
    if (value && *value >= 0.0 && *value < kMost && *value == std::floor(*value)) {
      return static_cast<int>(*value);
    }
    fail(column, "must be a whole number");
    return 0;
  }

  std::array<std::string_view, kColumns> columns_{};
  const std::string place_;
  Problems& problems_;
  bool failed_ = false;
};

Result<void> read_head(TextLines& lines) {
  std::string_view line;
  while (lines.next(line)) {
    std::array<std::string_view, kColumns> words{};
    const std::size_t count = split(line, words);
    if (count == 0) continue;
    if (count == 3 && words[0] == "QGC" && words[1] == "WPL" && words[2] == "110") return {};
    const std::string detail = "must be \"" + std::string(kHead) + "\"";
    return base::fail(Code::Invalid, lines.place() + " " + detail, {{lines.place(), detail}});
  }
  return base::fail(Code::Invalid, "the file is empty", {{"line 1", "is missing"}});
}

void append_row(std::string& out, const Command& c) {
  out += std::to_string(c.number) + (c.number == 0 ? "\t1\t" : "\t0\t") + std::to_string(c.frame) +
         '\t' + std::to_string(c.id);
  for (const auto& p : c.p) out += '\t' + fixed_number(p.value_or(0.0), kDecimals);
  out += '\t' + fixed_number(c.lat.value_or(0.0), kDecimals);
  out += '\t' + fixed_number(c.lon.value_or(0.0), kDecimals);
  out += '\t' + fixed_number(c.alt.value_or(0.0), 6);
  out += "\t1\n";
}

}  // namespace

namespace {

/// Of a row that begins with "line ".
std::size_t line_number(const FileRow& row) {
  constexpr std::size_t kPrefix = 5;
  std::size_t number = 0;
  std::from_chars(row.row.data() + kPrefix, row.row.data() + row.row.size(), number);
  return number;
}

class WaypointsReader {
 public:
  explicit WaypointsReader(std::string_view content) : lines_(content) {}

  Result<ImportedFile> read() {
    if (auto ok = read_head(lines_); !ok) return tl::unexpected<Error>(ok.error());
    std::string_view line;
    while (lines_.next(line)) {
      const std::size_t begin = line.find_first_not_of(" \t");
      if (begin == std::string_view::npos) continue;
      if (line[begin] == '#') {
        file_.rows.push_back(
            {lines_.place(), "comment", Outcome::LeftOut, "a comment", std::nullopt});
      } else if (commands_.size() < kMaxItems) {
        row(line);
        continue;
      }
      if (commands_.size() >= kMaxItems || file_.rows.size() >= kMaxRowsOfFile) {
        return base::fail(Code::TooLarge, "more than " + std::to_string(kMaxItems) + " rows",
                          {{lines_.place(), "is one row too many"}});
      }
    }
    std::vector<FileRow> rows;
    file_.fence = fence_from_commands(commands_, rows, problems_);
    add(std::move(rows));
    rows.clear();
    items_from_commands(commands_, file_.plan, rows, problems_);
    if (not_home_ && !rows.empty() && rows.front().row == *not_home_ && rows.front().item) {
      change_row(rows.front(), "it is not written as a home, so it is driven to");
    }
    add(std::move(rows));
    if (!problems_.none()) return tl::unexpected<Error>(std::move(problems_).error("the file"));
    return std::move(file_);
  }

 private:
  /// Keeps the rows in the file's order; both lists are.
  void add(std::vector<FileRow> rows) {
    const auto middle = static_cast<std::ptrdiff_t>(file_.rows.size());
    const bool behind =
        middle == 0 || rows.empty() || line_number(file_.rows.back()) < line_number(rows.front());
    file_.rows.insert(file_.rows.end(), std::make_move_iterator(rows.begin()),
                      std::make_move_iterator(rows.end()));
    if (behind) return;
    std::inplace_merge(
        file_.rows.begin(), file_.rows.begin() + middle, file_.rows.end(),
        [](const FileRow& a, const FileRow& b) { return line_number(a) < line_number(b); });
  }

  void row(std::string_view line) {
    auto command = RowReader(lines_.place(), problems_).read(line);
    if (!command) return;
    if (command->number <= before_) {
      problems_.add(lines_.place(), "number " + std::to_string(command->number) +
                                        " must be more than " + std::to_string(before_) +
                                        " of the row before");
    }
    before_ = command->number;
    if (command->number == 0 && is_home_command(*command)) {
      take_home(*command, file_.plan, file_.rows, problems_);
      return;
    }
    const bool is_point = command->id == cmd::kWaypoint || command->id == cmd::kSpline;
    if (command->number == 0 && is_point) not_home_ = command->row;
    commands_.push_back(std::move(*command));
  }

  TextLines lines_;
  std::vector<Command> commands_;
  int before_ = -1;
  std::optional<std::string> not_home_;  ///< row 0, if it could be taken for one
  ImportedFile file_;
  Problems problems_;
};

}  // namespace

Result<ImportedFile> read_waypoints(std::string_view content) {
  return WaypointsReader(without_bom(content)).read();
}

std::string write_waypoints(const Plan& plan, std::vector<FileRow>& rows) {
  std::string out(kHead);
  out += '\n';
  Command home;
  home.id = cmd::kWaypoint;
  home.frame = kFrameGlobal;
  home.lat = home.lon = 0.0;
  if (plan.home) {
    home.lat = plan.home->at.lat;
    home.lon = plan.home->at.lon;
    home.alt = plan.home->alt_m;
  } else {
    rows.push_back(
        {"/home", "home", Outcome::Changed, "not known: row 0 is written as 0/0", std::nullopt});
  }
  append_row(out, home);
  for (const Command& command : commands_from_items(plan, true, rows)) append_row(out, command);
  return out;
}

}  // namespace roverd::mission
