// What reading a map takes of the memory; not under sanitizers, which keep what is given back.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "nav/cells/lzf.hpp"
#include "nav/cells/map_file.hpp"

namespace roverd::nav::cells {
namespace {

long peak_kb() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return used.ru_maxrss;
}

//   Twelve million points, packed into half a megabyte.
TEST(MapFile, HoldsNoPointsWhileItReadsThem) {
  constexpr std::size_t kBlock = 1'000'000;  // values
  const auto zeros = pack_lzf(std::vector<std::uint8_t>(kBlock * 4));
  std::vector<std::uint8_t> packed;
  for (int i = 0; i < 3 * 12; ++i) packed.insert(packed.end(), zeros.begin(), zeros.end());
  const std::string head =
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 12000000\nHEIGHT 1\nDATA binary_compressed\n";
  std::vector<std::uint8_t> file(head.begin(), head.end());
  const std::array<std::uint32_t, 2> sizes = {static_cast<std::uint32_t>(packed.size()),
                                              3U * 12U * 4U * kBlock};
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(sizes.data());
  file.insert(file.end(), bytes, bytes + sizeof sizes);
  file.insert(file.end(), packed.begin(), packed.end());
  const long before_kb = peak_kb();
  // when
  const auto read = read_whole_map(file, 0.2);
  // then
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(read->map.cells().at(0).points, 12e6);
  EXPECT_LT(peak_kb() - before_kb, 20'000);
}

}  // namespace
}  // namespace roverd::nav::cells
