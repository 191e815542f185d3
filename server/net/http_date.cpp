#include "net/http_date.hpp"

#include <array>
#include <ctime>

#include "base/time.hpp"

namespace roverd::net {

const std::string& http_date_now() {
  thread_local std::time_t made = 0;
  thread_local std::string text;
  const auto now = std::chrono::floor<std::chrono::seconds>(base::wall_now());
  const std::time_t second = now.time_since_epoch().count();
  if (second == made) return text;
  static constexpr std::array<const char*, 7> kDays = {"Sun", "Mon", "Tue", "Wed",
                                                       "Thu", "Fri", "Sat"};
  static constexpr std::array<const char*, 12> kMonths = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                          "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  std::tm t{};
  gmtime_r(&second, &t);
  std::array<char, 40> out{};
  const std::size_t n = std::strftime(out.data(), out.size(), "%d  %Y %H:%M:%S GMT", &t);
  text.assign(out.data(), n);
  text.insert(3, kMonths[static_cast<std::size_t>(t.tm_mon)]);
  text.insert(0, std::string(kDays[static_cast<std::size_t>(t.tm_wday)]) + ", ");
  made = second;
  return text;
}

}  // namespace roverd::net
