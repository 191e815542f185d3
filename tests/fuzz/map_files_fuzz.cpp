// Any bytes as a map: words, a NUL, the picture. What is read
// is a map of allowed size, and what is written of it reads as the same.

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

#include "atlas/map_files.hpp"

namespace {

using namespace roverd;

void check(bool truth) {
  if (!truth) std::abort();
}

void write_again(const atlas::MapWords& words, const atlas::Picture& picture) {
  const auto map = atlas::map_of(words, picture);
  check(map.has_value());
  check(map->cells().size() == picture.values.size());
  const auto again = atlas::picture_of(*map, words);
  if (!again) return;  // unknown cells in the mode scale
  const auto read = atlas::read_pgm(atlas::write_pgm(*again));
  check(read.has_value());
  if (words.mode == atlas::MapMode::Scale) return;  // its cells come closer to their ends each time
  const auto map_again = atlas::map_of(words, *read);
  check(map_again.has_value());
  check(std::equal(map->cells().begin(), map->cells().end(), map_again->cells().begin()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  // The words end at the first NUL; without one, all is tried as either.
  const std::size_t end = std::min(text.find('\0'), size);
  const auto words = atlas::read_words(text.substr(0, end));
  if (words) {
    const auto again = atlas::read_words(atlas::write_words(*words));
    check(again.has_value());
    check(again->image == words->image && again->mode == words->mode);
    check(again->origin.x_m == words->origin.x_m && again->resolution_m == words->resolution_m);
  }
  const base::Bytes rest =
      end < size ? base::Bytes(data + end + 1, size - end - 1) : base::Bytes(data, size);
  const auto picture = atlas::read_pgm(rest);
  if (!picture || picture->values.size() > 100'000) return 0;
  write_again(words.value_or(atlas::MapWords{}), *picture);
  return 0;
}
