// What the robot asks about a row, and when it asks for the row anew.

#include <string>
#include <vector>

#include "robot/guard/row_watch.hpp"
#include "seeing.hpp"

namespace roverd::robot {
namespace {

class RowAsked : public Seeing {
 protected:
  RowAsked() {
    field.more = [this] {
      look();
      field.robot.row_questions().take(asked);
    };
    field.run(8.0);
    mission::Plan plan;
    plan.name = "row";
    plan.items.emplace_back(mission::Row{});
    EXPECT_TRUE(field.load(plan));
    EXPECT_TRUE(field.ask(Arm{}));
    EXPECT_TRUE(field.ask(StartMission{"m", 1}));
    field.run(2.0);
  }
  std::vector<RowQuestion> asked;
};

TEST_F(RowAsked, OnceThoughSomebodyWalkedBy) {
  ASSERT_TRUE(field.moves());
  wall_at(driven_m() + 1.0);
  field.run(2.0);
  ASSERT_FALSE(field.moves());
  wall_m.reset();
  field.run(5.0);
  ASSERT_TRUE(field.moves());
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_TRUE(asked[0].order);
}

TEST_F(RowAsked, AnewAfterAWord) {
  ASSERT_TRUE(field.ask(SetMode{Mode::Hold}));
  field.run(0.1);
  ASSERT_EQ(asked.size(), 2u);
  EXPECT_FALSE(asked[1].order);
  ASSERT_TRUE(field.ask(ResumeMission{}));
  field.run(0.1);
  ASSERT_EQ(asked.size(), 3u);
  EXPECT_NE(asked[2].id, asked[0].id);
}

TEST_F(RowAsked, OtherParametersAreToldOfTheSameRow) {
  ASSERT_TRUE(field.ask(SetParameter{"nav.rows.plant_m", 0.1}));
  field.run(0.1);
  ASSERT_EQ(asked.size(), 2u);
  EXPECT_EQ(asked[1].id, asked[0].id);
  EXPECT_EQ(asked[1].order, asked[0].order);
  EXPECT_EQ(asked[1].params.plant_m, 0.1);
}

}  // namespace
}  // namespace roverd::robot
