// The maps that are kept: over restarts, beside broken files, and through changes.

#include "maps/shelf.hpp"

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace {

using namespace roverd;
namespace fs = std::filesystem;
using base::Code;
using maps::Change;
using maps::Edit;
using maps::Shelf;
using nav::chart::kFree;
using nav::chart::kOccupied;
using nav::chart::OccupancyMap;

constexpr base::WallTime kNow = base::kYoungest + std::chrono::hours(5);

class ShelfTest : public ::testing::Test {
 protected:
  ShelfTest() {
    std::string name = (fs::temp_directory_path() / "roverd-maps-XXXXXX").string();
    EXPECT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  ~ShelfTest() override { fs::remove_all(folder_); }

  /// As after a restart.
  std::unique_ptr<Shelf> open(const std::optional<maps::Configured>& configured = {}) {
    auto opened = Shelf::open(folder_ / "maps", configured);
    EXPECT_TRUE(opened) << opened.error().detail;
    return opened ? std::move(*opened) : nullptr;
  }
  static OccupancyMap floor(std::int32_t columns = 4, std::int32_t rows = 3) {
    return *OccupancyMap::make({columns, rows, 0.5, {-1.0, -1.0, 0.0}}, kFree);
  }
  maps::Configured configured() {
    std::ofstream(folder_ / "hall.yaml")
        << "image: hall.pgm\nresolution: 0.1\norigin: [1, 2, 0]\nnegate: 0\n"
           "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
    std::ofstream(folder_ / "hall.pgm") << "P2 2 1 255 0 254";
    return {folder_ / "hall.yaml", maps::Anchor{{58.0, 26.0}, 90.0, 0.2, 1.0}};
  }
  fs::path file(const std::string& name) const { return folder_ / "maps" / name; }
  static Change wall() {
    Change c;
    c.edits = {{Edit::Kind::Wall, {{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}}};
    return c;
  }

  fs::path folder_;
};

TEST_F(ShelfTest, AMapIsKeptOverARestart) {
  auto shelf = open();
  EXPECT_TRUE(shelf->list().empty());
  const auto made = shelf->add("shed", floor(), maps::Anchor{{58.0, 26.0}, 45.0, 0.1, 0.5}, kNow);
  ASSERT_TRUE(made) << made.error().detail;
  EXPECT_EQ(made->id, 1);
  shelf = open();
  ASSERT_EQ(shelf->list().size(), 1u);
  const auto about = shelf->find(1);
  ASSERT_TRUE(about);
  EXPECT_EQ(about->name, "shed");
  EXPECT_EQ(about->created, kNow);
  EXPECT_EQ(about->shape.columns, 4);
  EXPECT_EQ(about->anchor->heading_deg, 45.0);
  EXPECT_EQ(about->size_bytes, fs::file_size(file("1/map.1.pgm")));
  const auto map = shelf->read(1);
  ASSERT_TRUE(map) << map.error().detail;
  EXPECT_EQ(map->at({3, 2}), kFree);
  EXPECT_EQ(shelf->find(2).error().code, Code::NotFound);
  EXPECT_EQ(shelf->add("barn", floor(), {}, kNow)->id, 2);
}

TEST_F(ShelfTest, NoTwoMapsAreCalledTheSame) {
  // Given: a map of the configuration, "hall", and a kept one, "shed".
  auto shelf = open(configured());
  ASSERT_TRUE(shelf->add("shed", floor(), {}, kNow));
  // When, then: a person who gives one of these names is refused, and told who has it.
  const auto refused = shelf->add("shed", floor(), {}, kNow);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::Conflict);
  EXPECT_NE(refused.error().detail.find("\"shed\" is taken by map 1"), std::string::npos);
  EXPECT_NE(shelf->add("hall", floor(), {}, kNow).error().detail.find("that of the configuration"),
            std::string::npos);
  ASSERT_EQ(shelf->add("barn", floor(), {}, kNow)->id, 2);
  Change change;
  for (const char* taken : {"shed", "hall"}) {
    change.name = taken;
    EXPECT_EQ(shelf->change(2, change).error().code, Code::Conflict) << taken;
  }
  EXPECT_EQ(shelf->find(2)->revision, 1);
  change.name = "barn";  // its own is no other map's
  EXPECT_TRUE(shelf->change(2, change));
  // Then: what nobody named gets a number.
  const auto numbered = [&](const std::string& name) {
    return shelf->add(name, floor(), {}, kNow, {}, maps::IfTaken::Number)->name;
  };
  EXPECT_EQ(numbered("shed"), "shed 2");
  EXPECT_EQ(numbered("shed"), "shed 3");
  EXPECT_EQ(numbered("yard"), "yard");
  std::string longest;
  for (int i = 0; i < 100; ++i) longest += "\u00e4";  // of two bytes each
  EXPECT_EQ(numbered(longest), longest);
  EXPECT_EQ(numbered(longest), longest.substr(0, 190) + " 2");
}

// As the program before this kept them.
TEST_F(ShelfTest, MapsThatWereCalledTheSameArePartedWhenItOpens) {
  // Given: four maps that are called "hall", of which the third is in use, and a "hall 2".
  auto shelf = open();
  for (const char* name : {"a", "b", "c", "d", "hall 2"}) {
    ASSERT_TRUE(shelf->add(name, floor(), {}, kNow));
  }
  ASSERT_TRUE(shelf->choose(3));
  ASSERT_TRUE(shelf->keep_choice());
  const auto call_all = [&] {
    for (const char* id : {"1", "2", "3", "4"}) {
      const fs::path about = file(std::string(id) + "/about.json");
      std::ifstream in(about);
      std::string text((std::istreambuf_iterator<char>(in)), {});
      const auto at = text.find("\"name\": \"");
      const auto end = text.find('"', at + 9);
      std::ofstream(about) << text.substr(0, at + 9) + "hall" + text.substr(end);
    }
  };
  call_all();
  const auto names = [&] {
    std::string out;
    for (const auto& about : shelf->list()) out += about.name + ", ";
    return out;
  };
  // When, then: the one in use keeps the name, and it is told.
  shelf = open();
  EXPECT_EQ(names(), "hall 3, hall 4, hall, hall 5, hall 2, ");
  ASSERT_EQ(shelf->troubles().size(), 3u);
  EXPECT_EQ(shelf->troubles()[0],
            "map 1 is called \"hall 3\" now: missions count from a map by its name, and \"hall\" "
            "is map 3");
  // Then: it stays so, and is told once.
  shelf = open();
  EXPECT_EQ(names(), "hall 3, hall 4, hall, hall 5, hall 2, ");
  EXPECT_TRUE(shelf->troubles().empty());
  // And: that of the configuration is called as its file, whoever is in use.
  call_all();
  shelf = open(configured());
  EXPECT_NE(shelf->troubles().at(0).find("is that of the configuration"), std::string::npos);
  EXPECT_EQ(names(), "hall, hall 3, hall 4, hall 5, hall 6, hall 2, ");
  EXPECT_EQ(shelf->in_use(), 3);
}

TEST_F(ShelfTest, AChangeHoldsAsAWhole) {
  auto shelf = open();
  (void)shelf->add("shed", floor(), {}, kNow);
  Change change = wall();
  change.name = "barn";
  change.edits.push_back({Edit::Kind::Forbid, {{0, 0}, {1, 0}, {1, 0.5}}});
  const auto changed = shelf->change(1, change);
  ASSERT_TRUE(changed) << changed.error().detail;
  EXPECT_EQ(changed->revision, 2);
  EXPECT_FALSE(fs::exists(file("1/map.1.pgm")));
  shelf = open();
  EXPECT_EQ(shelf->find(1)->name, "barn");
  ASSERT_EQ(shelf->find(1)->forbidden.size(), 1u);
  const auto map = shelf->read(1);
  EXPECT_EQ(map->at({1, 1}), kOccupied);
  EXPECT_EQ(map->at({2, 2}), kFree);  // what is forbidden is in no scanner's sight
  Change none;
  none.forbidden.emplace();
  none.changes_anchor = true;
  EXPECT_TRUE(shelf->change(1, none)->forbidden.empty());
  EXPECT_EQ(shelf->read(1)->at({1, 1}), kOccupied);
}

// One edit lies beside the map: nothing of the change is done.
TEST_F(ShelfTest, AnEditOutsideOfTheMapIsRefused) {
  auto shelf = open();
  (void)shelf->add("shed", floor(), {}, kNow);
  for (const auto kind : {Edit::Kind::Erase, Edit::Kind::Wall, Edit::Kind::Forbid}) {
    Change change = wall();
    change.edits.push_back({kind, {{500, 0}, {501, 0}, {501, 0.5}}});
    const auto refused = shelf->change(1, change);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Code::Invalid);
    EXPECT_EQ(refused.error().fields.at(0).pointer, "/edits/1/polygon");
  }
  EXPECT_EQ(shelf->find(1)->revision, 1);
  EXPECT_EQ(shelf->read(1)->at({1, 1}), kFree);
  // Partly outside it is done where the map is.
  Change over;
  over.edits = {{Edit::Kind::Wall, {{-500, -500}, {500, -500}, {500, 500}, {-500, 500}}}};
  ASSERT_TRUE(shelf->change(1, over));
  EXPECT_EQ(shelf->read(1)->at({1, 1}), kOccupied);
}

TEST_F(ShelfTest, AChangeThatWasCutOffLeavesTheMapAsItWas) {
  auto shelf = open();
  (void)shelf->add("shed", floor(), {}, kNow);
  // The power went when the new picture was there, and about.json was not.
  std::ofstream(file("1/map.2.pgm")) << "P5 half a pict";
  std::ofstream(file("1/about.json.new")) << "{\"na";
  fs::create_directory(file("new-2"));
  std::ofstream(file("new-2/map.1.pgm")) << "P5";
  fs::create_directory(file("gone-9"));
  shelf = open();
  EXPECT_TRUE(shelf->troubles().empty());
  EXPECT_EQ(shelf->list().size(), 1u);
  EXPECT_TRUE(shelf->read(1));
  for (const char* left : {"1/map.2.pgm", "1/about.json.new", "new-2", "gone-9"}) {
    EXPECT_FALSE(fs::exists(file(left))) << left;
  }
  EXPECT_EQ(shelf->change(1, wall())->revision, 2);
  EXPECT_EQ(shelf->read(1)->at({0, 0}), kOccupied);
}

TEST_F(ShelfTest, OneThatGoesIsGone) {
  auto shelf = open();
  (void)shelf->add("a", floor(), {}, kNow);
  (void)shelf->add("b", floor(), {}, kNow);
  ASSERT_TRUE(shelf->choose(2));
  EXPECT_EQ(shelf->remove(2).error().code, Code::Conflict);
  EXPECT_TRUE(shelf->remove(1));
  EXPECT_EQ(shelf->remove(1).error().code, Code::NotFound);
  EXPECT_FALSE(fs::exists(file("1")));
  EXPECT_EQ(shelf->choose(1).error().code, Code::NotFound);
  EXPECT_EQ(shelf->in_use(), 2);
}

TEST_F(ShelfTest, TheConfiguredMapIsUsedUntilSomebodyChooses) {
  auto shelf = open(configured());
  EXPECT_EQ(shelf->in_use(), maps::kConfigured);
  EXPECT_EQ(shelf->list()[0].name, "hall");
  EXPECT_EQ(shelf->read(0)->at({0, 0}), kOccupied);
  EXPECT_EQ(shelf->remove(0).error().code, Code::Conflict);
  EXPECT_EQ(shelf->change(0, wall()).error().code, Code::Conflict);
  (void)shelf->add("shed", floor(), {}, kNow);
  ASSERT_TRUE(shelf->choose(1));
  EXPECT_EQ(open(configured())->in_use(), maps::kConfigured);  // not kept yet
  ASSERT_TRUE(shelf->keep_choice());
  EXPECT_EQ(open(configured())->in_use(), 1);
  ASSERT_TRUE(shelf->choose(std::nullopt));
  ASSERT_TRUE(shelf->keep_choice());
  EXPECT_EQ(open(configured())->in_use(), std::nullopt);
  ASSERT_TRUE(shelf->choose(maps::kConfigured));
  ASSERT_TRUE(shelf->keep_choice());
  EXPECT_EQ(open(configured())->in_use(), maps::kConfigured);
  EXPECT_EQ(open()->in_use(), std::nullopt);  // it says none any more
}

TEST_F(ShelfTest, AChoiceThatCannotHoldIsToldAndNoOtherMapTakesItsPlace) {
  auto shelf = open(configured());
  (void)shelf->add("shed", floor(), {}, kNow);
  ASSERT_TRUE(shelf->choose(1));
  ASSERT_TRUE(shelf->keep_choice());
  fs::remove_all(file("1"));
  shelf = open(configured());
  EXPECT_EQ(shelf->in_use(), std::nullopt);
  ASSERT_EQ(shelf->troubles().size(), 1u);
  EXPECT_NE(shelf->troubles()[0].find("map 1, which was in use, is gone"), std::string::npos);
  // Nor does one that is added later.
  const auto later = shelf->add("barn", floor(), {}, kNow);
  ASSERT_TRUE(later);
  EXPECT_EQ(later->id, 2);
  EXPECT_EQ(open(configured())->in_use(), std::nullopt);
  fs::remove_all(file("2"));
  for (const char* text : {"", "[1]", "{\"map\": \"1\"}", "{\"map\": 1.5}", "{}"}) {
    std::ofstream(file("in_use.json"), std::ios::trunc) << text;
    shelf = open(configured());
    EXPECT_EQ(shelf->in_use(), std::nullopt) << text;
    EXPECT_EQ(shelf->troubles().size(), 1u) << text;
  }
}

TEST_F(ShelfTest, FilesThatVanishOrBreakAreTold) {
  auto shelf = open();
  for (const char* name : {"a", "b", "c"}) (void)shelf->add(name, floor(), {}, kNow);
  fs::remove(file("2/map.1.pgm"));
  EXPECT_TRUE(shelf->look()[0].problem.empty());
  EXPECT_NE(shelf->look()[1].problem.find("map.1.pgm"), std::string::npos);
  EXPECT_EQ(shelf->read(2).error().code, Code::Unavailable);
  EXPECT_EQ(shelf->read(9).error().code, Code::NotFound);
  EXPECT_FALSE(shelf->change(2, wall()));
  EXPECT_EQ(shelf->find(2)->revision, 1);
  std::ofstream(file("1/map.1.pgm"), std::ios::trunc) << "P5 100000 100000 255 ";
  EXPECT_EQ(shelf->read(1).error().code, Code::Unavailable);
  std::ofstream(file("3/about.json"), std::ios::trunc) << "{}";
  fs::create_directories(file("7"));
  fs::create_directories(file("lost+found"));
  shelf = open();
  EXPECT_EQ(shelf->troubles().size(), 3u);  // 2: no picture, 3: no name, 7: nothing at all
  EXPECT_EQ(shelf->list().size(), 2u);
  EXPECT_EQ(shelf->add("d", floor(), {}, kNow)->id, 8);  // no number is given twice
  EXPECT_TRUE(fs::exists(file("3/map.1.pgm")));          // what cannot be read is left
}

TEST_F(ShelfTest, ADiskThatRefusesKeepsNothing) {
  auto shelf = open();
  (void)shelf->add("a", floor(), {}, kNow);
  fs::remove_all(file(""));
  std::ofstream(folder_ / "maps") << "no folder any more";
  EXPECT_EQ(shelf->add("b", floor(), {}, kNow).error().code, Code::Unavailable);
  EXPECT_FALSE(shelf->change(1, wall()));
  Change name;
  name.name = "c";
  EXPECT_EQ(shelf->change(1, name).error().code, Code::Unavailable);
  EXPECT_EQ(shelf->find(1)->name, "a");
  EXPECT_EQ(shelf->keep_choice().error().code, Code::Unavailable);
  EXPECT_EQ(shelf->list().size(), 1u);
  EXPECT_EQ(Shelf::open(folder_ / "maps", {}).error().code, Code::Unavailable);
}

TEST_F(ShelfTest, ABrokenMapOfTheConfigurationIsAnErrorOnlyWhereItIsUsed) {
  auto said = configured();
  auto shelf = open(said);
  std::ofstream(folder_ / "hall.pgm", std::ios::trunc) << "P9";
  EXPECT_EQ(shelf->read(0).error().code, Code::Unavailable) << "who asks has sent nothing wrong";
  const auto refused = Shelf::open(folder_ / "maps", said);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().code, Code::Unavailable);
  EXPECT_NE(refused.error().detail.find("hall.pgm"), std::string::npos);
  // A robot that looks through no map starts without it,
  said.needed = false;
  shelf = open(said);
  EXPECT_EQ(shelf->in_use(), std::nullopt);
  ASSERT_EQ(shelf->troubles().size(), 1u);
  EXPECT_NE(shelf->look()[0].problem.find("hall.pgm"), std::string::npos);
  // and so does one for which somebody chose another.
  said.needed = true;
  (void)shelf->add("shed", floor(), {}, kNow);
  ASSERT_TRUE(shelf->choose(1));
  ASSERT_TRUE(shelf->keep_choice());
  shelf = open(said);
  EXPECT_EQ(shelf->in_use(), 1);
  EXPECT_EQ(shelf->troubles().size(), 1u);
  EXPECT_EQ(shelf->look(0)->problem, shelf->look()[0].problem);
}

TEST_F(ShelfTest, ANewMapLeavesRoomForOthersOnTheDisk) {
  const auto shelf = *Shelf::open(folder_ / "maps", {}, std::uintmax_t{1} << 62);
  const auto refused = shelf->add("a", floor(), {}, kNow);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::Unavailable);
  EXPECT_NE(refused.error().detail.find("almost full"), std::string::npos);
  EXPECT_TRUE(shelf->list().empty());
}

TEST_F(ShelfTest, AListIsBrief) {
  auto shelf = open();
  (void)shelf->add("a", floor(), maps::Anchor{{58.0, 26.0}, 45.0, 0.1, 0.5}, kNow);
  Change forbid;
  forbid.edits = {{Edit::Kind::Forbid, {{0, 0}, {1, 0}, {1, 1}}}};
  ASSERT_TRUE(shelf->change(1, forbid));
  const maps::About about = shelf->list().at(0);
  EXPECT_TRUE(about.forbidden.empty());
  EXPECT_EQ(about.name, "a");
  EXPECT_EQ(about.revision, 2);
  EXPECT_EQ(about.created, kNow);
  EXPECT_EQ(about.anchor->heading_deg, 45.0);
  EXPECT_GT(about.size_bytes, 0u);
  EXPECT_EQ(shelf->find(1)->forbidden.size(), 1u);
  EXPECT_EQ(shelf->label_of(1)->name, "a");
  EXPECT_EQ(shelf->label_of(1)->revision, 2);
  EXPECT_FALSE(shelf->label_of(2));
}

TEST_F(ShelfTest, AMapHasNotMoreAreasThanItMay) {
  auto shelf = open();
  (void)shelf->add("a", floor(), {}, kNow);
  Change change;
  change.forbidden.emplace(maps::kMostForbidden, maps::Area{{0, 0}, {1, 0}, {1, 1}});
  EXPECT_TRUE(shelf->change(1, change));
  Change more;
  more.edits = {{Edit::Kind::Forbid, {{0, 0}, {1, 0}, {1, 1}}}};
  EXPECT_EQ(shelf->change(1, more).error().fields.at(0).pointer, "/edits");
}

}  // namespace
