#include "app/drawing_mark.hpp"

#include <fstream>
#include <system_error>

#include "base/log.hpp"

namespace roverd {

namespace {

constexpr std::size_t kWhen = 20;  // 2026-01-31T12:00:00Z

/// What stands there is told to people: only as long, and of such letters, as is written.
bool is_when(const std::string& text) {
  return text.size() >= kWhen && text.size() <= kWhen + 10 &&
         text.find_first_not_of("0123456789-:.TZ") == std::string::npos;
}

}  // namespace

std::optional<std::string> DrawingMark::found() {
  std::string when;
  {
    std::ifstream in(file_);
    if (!in) return std::nullopt;
    char text[64] = {};
    in.read(text, sizeof text - 1);
    when.assign(text, static_cast<std::size_t>(in.gcount()));
    if (!when.empty() && when.back() == '\n') when.pop_back();
  }
  ended();
  return "a map was being made by driving" + (is_when(when) ? ", begun at " + when : "") +
         ", as the program ended: nothing of that drive is kept. Begin it anew";
}

void DrawingMark::begun(base::WallTime now) noexcept {
  try {
    std::ofstream out(file_, std::ios::trunc);
    out << base::to_rfc3339(now) << '\n';
    out.flush();
    if (!out) base::log(base::Level::Warning, "place", file_.string() + " cannot be written");
  } catch (const std::exception&) {
    // As if there were no room: nothing is told after a restart.
  }
}

void DrawingMark::ended() noexcept {
  std::error_code error;
  std::filesystem::remove(file_, error);
}

}  // namespace roverd
