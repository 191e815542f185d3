#include "mission/edit/compare.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace roverd::mission {

namespace {

using Pair = std::pair<std::size_t, std::size_t>;

/// Longest common subsequence of the items [first, a_end) and [first, b_end), as pairs of indices.
/// Source: Wagner and Fischer 1974.
std::vector<Pair> common_items(const std::vector<Item>& a, std::size_t a_end,
                               const std::vector<Item>& b, std::size_t b_end, std::size_t first) {
  const std::size_t rows = a_end - first;
  const std::size_t columns = b_end - first;
  constexpr std::size_t kMaxCells = 4'000'000;
  if (rows == 0 || columns == 0 || rows > kMaxCells / columns) return {};
  std::vector<std::uint32_t> length((rows + 1) * (columns + 1), 0);
  const auto cell = [&](std::size_t i, std::size_t j) -> std::uint32_t& {
    return length[i * (columns + 1) + j];
  };
  for (std::size_t i = rows; i-- > 0;) {
    for (std::size_t j = columns; j-- > 0;) {
      cell(i, j) = a[first + i] == b[first + j] ? cell(i + 1, j + 1) + 1
                                                : std::max(cell(i + 1, j), cell(i, j + 1));
    }
  }
  std::vector<Pair> out;
  for (std::size_t i = 0, j = 0; i < rows && j < columns;) {
    if (a[first + i] == b[first + j]) {
      out.emplace_back(first + i++, first + j++);
    } else if (cell(i + 1, j) >= cell(i, j + 1)) {
      ++i;
    } else {
      ++j;
    }
  }
  return out;
}

class Comparison {
 public:
  Comparison(const Plan& before, const Plan& now) : a_(before.items), b_(now.items) {
    out_.name = before.name != now.name;
    out_.home = before.home != now.home;
    out_.settings = before.settings != now.settings;
    out_.frame = before.frame != now.frame;
  }

  Differences run() {
    std::size_t first = 0;
    while (first < a_.size() && first < b_.size() && a_[first] == b_[first]) ++first;
    std::size_t a_end = a_.size();
    std::size_t b_end = b_.size();
    while (a_end > first && b_end > first && a_[a_end - 1] == b_[b_end - 1]) {
      --a_end;
      --b_end;
    }
    out_.unchanged = first + (a_.size() - a_end);
    std::size_t i = first;
    std::size_t j = first;
    for (const auto& [same_a, same_b] : common_items(a_, a_end, b_, b_end, first)) {
      gap(i, same_a, j, same_b);
      ++out_.unchanged;
      i = same_a + 1;
      j = same_b + 1;
    }
    gap(i, a_end, j, b_end);
    return std::move(out_);
  }

 private:
  /// Nothing in it is the same: by place, then what is left over.
  void gap(std::size_t i, std::size_t i_end, std::size_t j, std::size_t j_end) {
    for (; i < i_end && j < j_end; ++i, ++j) {
      if (a_[i] == b_[j]) {
        ++out_.unchanged;
      } else {
        ++out_.changed;
        note({ItemChange::Changed, number(i), number(j), moved_m(a_[i], b_[j])});
      }
    }
    for (; i < i_end; ++i) {
      ++out_.removed;
      note({ItemChange::Removed, number(i), std::nullopt, std::nullopt});
    }
    for (; j < j_end; ++j) {
      ++out_.added;
      note({ItemChange::Added, std::nullopt, number(j), std::nullopt});
    }
  }

  static int number(std::size_t index) { return static_cast<int>(index) + 1; }

  static std::optional<double> moved_m(const Item& a, const Item& b) {
    const auto from = place_of(a);
    const auto to = place_of(b);
    if (a.index() != b.index() || !from || !to || *from == *to) return std::nullopt;
    return base::distance_bearing(*from, *to).distance_m;
  }

  void note(ItemDifference difference) {
    if (out_.items.size() < kMaxDifferences) out_.items.push_back(difference);
  }

  const std::vector<Item>& a_;
  const std::vector<Item>& b_;
  Differences out_;
};

}  // namespace

std::string_view to_string(ItemChange change) noexcept {
  switch (change) {
    case ItemChange::Added:
      return "added";
    case ItemChange::Removed:
      return "removed";
    case ItemChange::Changed:
      return "changed";
  }
  return "changed";
}

Differences compare(const Plan& before, const Plan& now) {
  return Comparison(before, now).run();
}

}  // namespace roverd::mission
