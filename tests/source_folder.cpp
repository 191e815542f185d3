#include "source_folder.hpp"

namespace roverd::tests {

std::filesystem::path source_folder() {
  return SOURCE_FOLDER;
}

std::filesystem::path in_source(std::string_view name) {
  return source_folder() / name;
}

}  // namespace roverd::tests
