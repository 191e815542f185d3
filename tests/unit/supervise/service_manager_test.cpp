// What a service manager hears.

#include "supervise/service_manager.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace roverd {
namespace {

/// The manager's end, a name in the kernel.
class Manager {
 public:
  Manager() : name_("@roverd-test-manager-" + std::to_string(::getpid())) {
    fd_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    name_.copy(address.sun_path, name_.size());
    address.sun_path[0] = '\0';
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name_.size());
    EXPECT_EQ(::bind(fd_, reinterpret_cast<const sockaddr*>(&address), length), 0);
  }
  ~Manager() { ::close(fd_); }
  const std::string& name() const { return name_; }
  std::vector<std::string> heard() {
    std::vector<std::string> out;
    char text[256];
    for (ssize_t n = 0; (n = ::recv(fd_, text, sizeof text, 0)) > 0;) {
      out.emplace_back(text, static_cast<std::size_t>(n));
    }
    return out;
  }

 private:
  std::string name_;
  int fd_ = -1;
};

using Words = std::vector<std::string>;

TEST(ServiceManager, HearsThatTheRobotIsServedAndThatItStops) {
  Manager there;
  ServiceManager manager(there.name(), "");
  manager.ready("http://127.0.0.1:8080");
  manager.stopping();
  EXPECT_EQ(there.heard(), (Words{"READY=1\nSTATUS=serving http://127.0.0.1:8080", "STOPPING=1"}));
  EXPECT_FALSE(manager.period());
}

TEST(ServiceManager, HearsNothingOfALoopThatHangs) {
  // Given a manager that waits 3 s,
  Manager there;
  ServiceManager manager(there.name(), "3000000");
  EXPECT_EQ(manager.period(), base::Duration(std::chrono::seconds(1)));
  // when the loop ticks, hangs, and ticks again,
  for (const std::uint64_t ticks : {50u, 100u, 100u, 100u, 101u}) manager.alive(ticks);
  // then only its ticks are life.
  EXPECT_EQ(there.heard(), (Words{"WATCHDOG=1", "WATCHDOG=1", "WATCHDOG=1"}));
}

TEST(ServiceManager, WithoutOneNothingIsToldAndAWrongPeriodIsNone) {
  ServiceManager none("", "3000000");
  EXPECT_FALSE(none.period());
  none.ready("somewhere");
  none.alive(1);
  Manager there;
  for (const char* wrong : {"0", "-5", "3 s", "3000000 ", "99999999999999999999999"}) {
    EXPECT_FALSE(ServiceManager(there.name(), wrong).period()) << wrong;
  }
  ServiceManager gone("@roverd-test-nobody-" + std::to_string(::getpid()), "");
  gone.ready("somewhere");  // is not waited for, and breaks nothing
  ServiceManager long_name(std::string(300, 'x'), "3000000");
  long_name.ready("somewhere");
  EXPECT_EQ(there.heard(), Words{});
}

}  // namespace
}  // namespace roverd
