#include "api/idempotency.hpp"

#include <gtest/gtest.h>

#include "api/problem.hpp"

namespace roverd::api {
namespace {

class IdempotencyTest : public ::testing::Test {
 protected:
  CallPtr call(const char* key, std::string body = "{}") {
    auto out = std::make_shared<Call>();
    out->request = Request{http::verb::post, "/api/v1/missions", 11};
    if (key != nullptr) out->request.set("Idempotency-Key", key);
    out->request.body() = std::move(body);
    out->respond = [this](Response response) {
      statuses.push_back(response.result_int());
      bodies.push_back(response.body());
    };
    return out;
  }
  static Response answer(http::status status, const char* body) {
    Response response{status, 11};
    response.body() = body;
    return response;
  }

  Idempotency keys;
  std::vector<unsigned> statuses;
  std::vector<std::string> bodies;
};

TEST_F(IdempotencyTest, ARepeatedKeyGivesTheFirstAnswerAgain) {
  // Given a request that was answered,
  CallPtr first = call("k1");
  ASSERT_TRUE(keys.admit(first));
  first->respond(answer(http::status::created, "mission 1"));
  // when it comes again (the client did not hear the answer),
  CallPtr again = call("k1");
  EXPECT_FALSE(keys.admit(again));
  // then nothing is done twice.
  EXPECT_EQ(bodies, (std::vector<std::string>{"mission 1", "mission 1"}));
  EXPECT_EQ(statuses, (std::vector<unsigned>{201, 201}));
}

TEST_F(IdempotencyTest, ARepeatWhileTheFirstIsOnItsWayWaitsForIt) {
  CallPtr first = call("k1");
  ASSERT_TRUE(keys.admit(first));
  CallPtr again = call("k1");
  EXPECT_FALSE(keys.admit(again));
  EXPECT_TRUE(bodies.empty());
  first->respond(answer(http::status::ok, "done"));
  EXPECT_EQ(bodies, (std::vector<std::string>{"done", "done"}));
}

TEST_F(IdempotencyTest, WhoeverWaitsKeepsItsRequestUntilTheAnswer) {
  const CallPtr first = call("k1");
  ASSERT_TRUE(keys.admit(first));
  CallPtr again = call("k1");
  const std::weak_ptr<Call> request = again;
  EXPECT_FALSE(keys.admit(again));
  again.reset();
  EXPECT_FALSE(request.expired());
  first->respond(answer(http::status::ok, "done"));
  EXPECT_EQ(bodies.size(), 2u);
  EXPECT_TRUE(request.expired());
}

TEST_F(IdempotencyTest, TheSameKeyWithAnotherBodyIsAMistake) {
  CallPtr first = call("k1", "{\"a\":1}");
  ASSERT_TRUE(keys.admit(first));
  first->respond(answer(http::status::ok, "done"));
  CallPtr other = call("k1", "{\"a\":2}");
  EXPECT_FALSE(keys.admit(other));
  EXPECT_EQ(statuses.back(), 422u);
}

TEST_F(IdempotencyTest, ARefusalThatSaysTryAgainIsNotKept) {
  CallPtr first = call("k1");
  ASSERT_TRUE(keys.admit(first));
  first->respond(problem({base::Code::Unavailable, "busy"}));
  CallPtr again = call("k1");
  EXPECT_TRUE(keys.admit(again));
}

TEST_F(IdempotencyTest, WithoutAKeyNothingIsRemembered) {
  CallPtr one = call(nullptr);
  CallPtr two = call(nullptr);
  EXPECT_TRUE(keys.admit(one));
  EXPECT_TRUE(keys.admit(two));
  CallPtr long_key = call(std::string(201, 'k').c_str());
  EXPECT_FALSE(keys.admit(long_key));
  EXPECT_EQ(statuses.back(), 422u);
}

TEST_F(IdempotencyTest, TheOldestAnswersAreForgottenFirst) {
  for (std::size_t i = 0; i <= Idempotency::kKeys; ++i) {
    CallPtr one = call(("k" + std::to_string(i)).c_str());
    ASSERT_TRUE(keys.admit(one));
    one->respond(answer(http::status::ok, "done"));
  }
  CallPtr newest = call("k5");
  CallPtr oldest = call("k0");
  EXPECT_FALSE(keys.admit(newest));
  EXPECT_TRUE(keys.admit(oldest));
}

}  // namespace
}  // namespace roverd::api
