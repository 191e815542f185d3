#pragma once
// What the tests on a kernel with CAN share: making interfaces, and one program on a bus.

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "link/socketcan.hpp"
#include "tools.hpp"

namespace roverd::link {

inline void ip(const std::string& words) {
  ASSERT_EQ(std::system(("ip link " + words).c_str()), 0) << words;
}

struct Node {
  Node(asio::io_context& io, const std::string& interface, CanOptions options = {})
      : link(io, interface, std::move(options)) {
    link.on_frame = [this](const CanFrame& f, Time t) {
      heard.push_back(f);
      stamps.push_back(t);
    };
    link.on_closed = [this](const std::string& reason) { closed = reason; };
  }
  SocketCanLink link;
  std::vector<CanFrame> heard;
  std::vector<Time> stamps;
  std::string closed;
};

}  // namespace roverd::link
