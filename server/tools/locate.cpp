#include "tools/locate.hpp"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "atlas/map_files.hpp"

namespace roverd {

namespace {

base::Result<std::vector<std::uint8_t>> bytes_of(const std::filesystem::path& path) {
  constexpr std::uintmax_t kLargest = 512ULL * 1024 * 1024;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream in(path, std::ios::binary);
  if (error || !in) return base::fail(base::Code::NotFound, "cannot be read");
  if (size > kLargest) return base::fail(base::Code::TooLarge, "is larger than 512 MiB");
  return std::vector<std::uint8_t>(std::istreambuf_iterator<char>(in), {});
}

int say_wrong(const std::filesystem::path& path, const base::Error& error) {
  std::fprintf(stderr, "roverd: %s: %s\n", path.c_str(), error.detail.c_str());
  return 1;
}

}  // namespace

int locate(const LocateCommand& command) {
  const auto text = bytes_of(command.map);
  if (!text) return say_wrong(command.map, text.error());
  const auto words = atlas::read_words({reinterpret_cast<const char*>(text->data()), text->size()});
  if (!words) return say_wrong(command.map, words.error());
  const std::filesystem::path image = command.map.parent_path() / words->image;
  const auto file = bytes_of(image);
  if (!file) return say_wrong(image, file.error());
  const auto picture = atlas::read_pgm(*file);
  if (!picture) return say_wrong(image, picture.error());
  const auto map = atlas::map_of(*words, *picture);
  if (!map) return say_wrong(command.map, map.error());
  const auto log = bytes_of(command.log);
  if (!log) return say_wrong(command.log, log.error());
  const auto scans = scans_of_log(*log);
  if (!scans) return say_wrong(command.log, scans.error());
  const auto field = std::make_shared<const nav::place::Field>(*map);
  const std::string figures =
      command.starts > 0
          ? figures_text(start_in_log(field, *scans, command.options, command.starts))
          : figures_text(locate_log(field, *scans, command.options));
  std::fputs(figures.c_str(), stdout);
  return 0;
}

}  // namespace roverd
