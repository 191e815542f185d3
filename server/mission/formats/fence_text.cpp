// ArduPilot's older texts, apart by blanks or tabs:
//
//   # saved by …              a comment
//   -35.36 149.16             a fence: first the point to return to,
//   -35.37 149.15 …           then the corners, of which the last is the first one again
//
//   RALLY -35.36 149.16 100 40 0 0    a rally point: latitude, longitude, height, and what is for
//                                     landing (height of the break, direction, flags)
// Source: ArduPilot's documentation of fence and rally point files (before MAVLink's mission
// types).

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "mission/formats/file_formats.hpp"
#include "mission/formats/text_lines.hpp"
#include "mission/formats/track_points.hpp"
#include "mission/json/fields.hpp"
#include "mission/json/pointer.hpp"
#include "mission/text.hpp"

namespace roverd::mission {
namespace {

using base::Error;
using base::Result;

constexpr std::size_t kRallyWords = 7;

/// Words apart by blanks, tabs or commas; one more than fits tells that there are more.
struct Words {
  std::array<std::string_view, kRallyWords + 1> word{};
  std::size_t count = 0;

  explicit Words(std::string_view line) {
    constexpr std::string_view kApart = " \t,";
    while (count < word.size()) {
      const std::size_t begin = line.find_first_not_of(kApart);
      if (begin == std::string_view::npos) return;
      line.remove_prefix(begin);
      word[count] = line.substr(0, line.find_first_of(kApart));
      line.remove_prefix(word[count].size());
      ++count;
    }
  }
  bool is_note() const { return count == 0 || word[0].starts_with('#'); }
  bool is_rally() const { return count > 0 && word[0] == "RALLY"; }
};

std::optional<double> plain_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = ec == std::errc{} && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

class FenceText {
 public:
  explicit FenceText(std::string_view content) : lines_(content) {}

  Result<ImportedFile> read() {
    std::string_view line;
    while (lines_.next(line)) {
      const Words words(line);
      if (words.count == 0) continue;
      if (corners_.points.size() + fence_.rally.size() > kMaxFencePoints) {
        return base::fail(base::Code::TooLarge,
                          "more than " + std::to_string(kMaxFencePoints) + " rows");
      }
      if (words.is_note()) {
        row("comment", Outcome::LeftOut, "a comment");
      } else if (words.is_rally()) {
        rally(words);
      } else {
        corner(words);
      }
    }
    close();
    if (!problems_.none()) return tl::unexpected<Error>(std::move(problems_).error("the file"));
    if (fence_.areas.empty() && fence_.rally.empty()) {
      return base::fail(base::Code::Invalid, "the file has no fence and no rally point",
                        {{"line 1", "must be a latitude and a longitude, or RALLY"}});
    }
    file_.fence = std::move(fence_);
    return std::move(file_);
  }

 private:
  void row(const char* what, Outcome outcome = Outcome::Taken, const char* reason = "") {
    file_.rows.push_back({lines_.place(), what, outcome, reason, std::nullopt});
  }

  std::optional<LatLon> position(const Words& words, std::size_t first) {
    const auto lat = plain_number(words.word[first]);
    const auto lon = plain_number(words.word[first + 1]);
    if (lat && lon && base::is_valid({*lat, *lon})) return LatLon{*lat, *lon};
    problems_.add(lines_.place(),
                  "must be a latitude from -90 to 90 and a longitude from -180 to "
                  "180");
    return std::nullopt;
  }

  void rally(const Words& words) {
    if (words.count < 3 || words.count > kRallyWords) {
      problems_.add(lines_.place(),
                    "must be RALLY, latitude, longitude, height and at most three numbers more");
      return;
    }
    const auto at = position(words, 1);
    if (!at) return;
    RallyPoint point{*at, std::nullopt};
    row("rally point");
    if (words.count > 3) {
      const auto alt_m = plain_number(words.word[3]);
      if (alt_m && kAlt_m.holds(*alt_m)) point.alt_m = alt_m;
      if (!point.alt_m) change_row(file_.rows.back(), "its height cannot be kept");
    }
    fence_.rally.push_back(point);
  }

  void corner(const Words& words) {
    if (words.count != 2) {
      problems_.add(lines_.place(), "must be a latitude and a longitude");
      return;
    }
    const auto at = position(words, 0);
    if (!at) return;
    if (!returns_) {
      returns_ = true;
      return row("return point", Outcome::LeftOut,
                 "the robot stops at a fence; rally points are where it can be sent");
    }
    row("corner");
    if (corners_.points.empty()) first_place_ = lines_.place();
    corners_.points.push_back(*at);
  }

  void close() {
    if (!returns_) return;
    auto& points = corners_.points;
    if (points.size() > 1 && points.front() == points.back()) {
      points.pop_back();
    } else if (!points.empty()) {
      change_row(file_.rows.back(),
                 "the figure is not closed in the file: from here to its first "
                 "corner");
    }
    FenceArea area{AreaKind::Inclusion, std::move(corners_)};
    if (const auto fine = check_fence({"fence", {area}, {}}); !fine) {
      const auto& fields = fine.error().fields;
      problems_.add(first_place_.empty() ? lines_.place() : first_place_,
                    "the figure " + (fields.empty() ? fine.error().detail : fields.front().detail));
      return;
    }
    fence_.areas.push_back(std::move(area));
  }

  TextLines lines_;
  bool returns_ = false;  ///< the return point was there
  std::string first_place_;
  FencePolygon corners_;
  Fence fence_;
  ImportedFile file_;
  Problems problems_;
};

}  // namespace

/// Rally points, or a short list of pairs that is closed behind its first one.
bool looks_like_fence_text(std::string_view content) {
  constexpr std::size_t kMostRows = 500;
  constexpr std::size_t kLeastRows = 5;
  TextLines lines(content);
  std::string_view line;
  std::array<LatLon, 2> first{};
  LatLon last;
  std::size_t count = 0;
  while (lines.next(line)) {
    const Words words(line);
    if (words.is_note()) continue;
    if (words.is_rally()) return words.count >= 3 && plain_number(words.word[1]).has_value();
    if (words.count != 2 || line.find(',') != std::string_view::npos || count == kMostRows) {
      return false;
    }
    const auto lat = plain_number(words.word[0]);
    const auto lon = plain_number(words.word[1]);
    if (!lat || !lon) return false;
    last = {*lat, *lon};
    if (count < first.size()) first[count] = last;
    ++count;
  }
  return count >= kLeastRows && first[1] == last && !(first[0] == last);
}

Result<ImportedFile> read_fence_text(std::string_view content) {
  return FenceText(without_bom(content)).read();
}

}  // namespace roverd::mission
