// Who gets in, of whom there are many already.

#include "net/peers.hpp"

#include <gtest/gtest.h>

namespace roverd::net {
namespace {

/// Always busy.
class Guest : public Peer {
 public:
  explicit Guest(bool reserve) : reserve_(reserve) {}
  void sweep(base::Time) override {}
  void stop() override {}
  void force() override {}
  std::optional<base::Time> gives_way() const override { return std::nullopt; }
  bool on_reserve() const override { return reserve_; }

 private:
  bool reserve_;
};

class PeersTest : public testing::Test {
 protected:
  static Limits limits() {
    Limits l;
    l.connections = 16;
    l.per_address = 2;
    l.reserve = 8;
    l.kept = 64;
    return l;
  }
  static From at(const std::string& address) {
    return counted_as(boost::asio::ip::make_address(address));
  }
  /// One more busy one of it. @return it got in
  bool enters(const std::string& address) {
    const bool in = peers.makes_room(at(address));
    if (in) sits(address, false);
    return in;
  }
  bool enters_reserve(const std::string& address) {
    const bool in = peers.makes_room_on_reserve(at(address));
    if (in) sits(address, true);
    return in;
  }
  void sits(const std::string& address, bool reserve) {
    guests.push_back(std::make_shared<Guest>(reserve));
    peers.add(guests.back().get(), guests.back(), at(address));
  }

  boost::asio::io_context io;
  std::vector<std::shared_ptr<Guest>> guests;
  Peers peers{io, limits(), [] {
                Handlers h;
                h.knows = [](const std::string& address) { return address == "10.0.0.7"; };
                return h;
              }()};
};

TEST_F(PeersTest, OneNetworkOfIpv6HasFourAddressesShare) {
  // Given a computer that takes another of its 2^64 addresses each time,
  int entered = 0;
  for (int i = 1; i <= 12; ++i) entered += enters("2001:db8::" + std::to_string(i)) ? 1 : 0;
  // then it has what four have, and others are served;
  EXPECT_EQ(entered, 8);
  EXPECT_TRUE(enters("2001:db8:0:1::1"));
  EXPECT_TRUE(enters("10.0.0.1"));
  EXPECT_TRUE(enters("::1"));
  // one address of it has no more than its own.
  EXPECT_TRUE(enters("2001:db8:0:1::1"));
  EXPECT_FALSE(enters("2001:db8:0:1::1"));
}

TEST_F(PeersTest, OneNetworkOfIpv6HasHalfOfTheReserve) {
  int entered = 0;
  for (int i = 1; i <= 12; ++i) entered += enters_reserve("fe80::" + std::to_string(i)) ? 1 : 0;
  EXPECT_EQ(entered, 4);
  EXPECT_TRUE(enters_reserve("10.0.0.1"));
  EXPECT_TRUE(enters_reserve("fd00::1"));
}

TEST_F(PeersTest, WhoBelongsHereHasRoomThatNobodyElseFills) {
  // Given as many unknown addresses as it takes to fill the house,
  int entered = 0;
  for (int i = 1; i <= 40; ++i) entered += enters("10.0.1." + std::to_string(i)) ? 1 : 0;
  // then an eighth is left,
  EXPECT_EQ(entered, 14);
  // in which whoever has logged in is served, and this computer.
  EXPECT_FALSE(enters("10.0.0.8"));
  EXPECT_TRUE(enters("10.0.0.7"));
  EXPECT_TRUE(enters("127.0.0.1"));
  EXPECT_FALSE(enters("10.0.0.7"));
}

}  // namespace
}  // namespace roverd::net
