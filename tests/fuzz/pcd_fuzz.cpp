// Any bytes as a PCD file: read within what they can hold, and what is read is written and read as
// the same; any bytes as packed data.

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "nav/cells/lzf.hpp"
#include "nav/cells/map_file.hpp"
#include "nav/cells/pcd.hpp"

namespace {

using namespace roverd;
using namespace roverd::nav;

void check(bool truth) {
  if (!truth) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const base::Bytes bytes(data, size);
  if (const auto plain = cells::unpack_lzf(bytes, size * 3)) check(plain->size() == size * 3);
  const auto again = cells::unpack_lzf(cells::pack_lzf(bytes), size);
  check(again && std::equal(again->begin(), again->end(), bytes.begin(), bytes.end()));

  const auto map = cells::read_whole_map(bytes, 0.2);
  if (map) {
    check(map->map.cells().size() + map->no_number + map->too_far <= map->points);
    check(cells::read_map(cells::write_map(map->map), 0.2).has_value());
  }
  const auto cloud = cells::read_pcd_cloud(bytes);
  if (!cloud) return 0;
  check(cloud->size() <= size * cells::kLzfMostTimes);
  for (const auto form :
       {cells::PcdData::Ascii, cells::PcdData::Binary, cells::PcdData::Compressed}) {
    const auto file = cells::write_pcd(cells::pcd_table(*cloud), form);
    check(file.has_value());
    const auto back = cells::read_pcd_cloud(*file);
    check(back && back->size() == cloud->size());
    for (std::size_t i = 0; i < cloud->size(); ++i) {
      for (const int axis : {0, 1, 2}) {
        const float was = (*cloud)[i][axis];
        const float is = (*back)[i][axis];
        check(was == is || (was != was && is != is));
      }
    }
  }
  return 0;
}
