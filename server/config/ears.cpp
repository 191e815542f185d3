#include "config/ears.hpp"

#include <string>

namespace roverd {

std::vector<Ear> ears_of(Settings s) {
  std::vector<Ear> out{{"server.port", "listen:" + std::to_string(s.server.port)}};
  drivers(
      [&out](const std::string& name, const auto& driver) {
        if (driver.wiring.enabled) out.push_back({"drivers." + name + ".link", driver.wiring.link});
      },
      s);
  return out;
}

}  // namespace roverd
