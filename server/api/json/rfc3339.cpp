#include "api/json/rfc3339.hpp"

#include <chrono>

namespace roverd::api {

namespace {

/// Nanoseconds since 1970 in 64 bits reach a little further.
constexpr int kLastYear = 2200;

/// Takes characters off the front of a text; remembers whether all of them fitted.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  int digits(int count, int max) {
    int value = 0;
    for (int i = 0; i < count; ++i) {
      if (rest_.empty() || rest_.front() < '0' || rest_.front() > '9') {
        ok_ = false;
        return 0;
      }
      value = value * 10 + (rest_.front() - '0');
      rest_.remove_prefix(1);
    }
    if (value > max) ok_ = false;
    return value;
  }

  bool take(char a, char b) {
    if (rest_.empty() || (rest_.front() != a && rest_.front() != b)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void need(char a, char b) { ok_ = take(a, b) && ok_; }

  /// Nanoseconds of ".25"; further digits are left out.
  std::int64_t fraction() {
    if (!take('.', ',')) return 0;
    std::int64_t value = 0;
    std::int64_t unit = 100'000'000;
    bool any = false;
    while (!rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9') {
      value += unit * (rest_.front() - '0');
      unit /= 10;
      any = true;
      rest_.remove_prefix(1);
    }
    ok_ = ok_ && any;
    return value;
  }

  bool whole() const { return ok_ && rest_.empty(); }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace

std::optional<base::WallTime> from_rfc3339(std::string_view text) noexcept {
  using namespace std::chrono;
  Reader in(text);
  const int y = in.digits(4, 9999);
  in.need('-', '-');
  const int m = in.digits(2, 12);
  in.need('-', '-');
  const int d = in.digits(2, 31);
  in.need('T', 't');
  const int hour = in.digits(2, 23);
  in.need(':', ':');
  const int minute = in.digits(2, 59);
  in.need(':', ':');
  const int second = in.digits(2, 60);
  const std::int64_t nanos = in.fraction();
  minutes offset{0};
  if (!in.take('Z', 'z')) {
    const bool west = in.take('-', '-');
    if (!west) in.need('+', '+');
    offset = hours(in.digits(2, 23));
    in.need(':', ':');
    offset += minutes(in.digits(2, 59));
    if (west) offset = -offset;
  }
  const year_month_day date{year(y), month(static_cast<unsigned>(m)),
                            day(static_cast<unsigned>(d))};
  if (!in.whole() || y < 1970 || !date.ok()) return std::nullopt;
  if (y > kLastYear) return base::WallTime(sys_days(year(kLastYear + 1) / 1 / 1));
  return base::WallTime(sys_days(date) + hours(hour) + minutes(minute) + seconds(second) +
                        nanoseconds(nanos) - offset);
}

}  // namespace roverd::api
