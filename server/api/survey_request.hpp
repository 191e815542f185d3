#pragma once
// The body of POST /missions/survey. Pure.

#include <optional>
#include <string>

#include "api/message.hpp"
#include "mission/survey/survey.hpp"

namespace roverd::api {

/// What a survey may need to know beside its body.
struct SurveyFacts {
  std::optional<base::LatLon> vehicle;
  double speed_mps = 0.8;  ///< when nobody says
  double turn_rate_radps = 0.75;
};

struct SurveyOrder {
  mission::SurveyRequest request;
  std::optional<std::string> name;  ///< to be stored under
  std::optional<double> speed_mps;  ///< of the mission
};

/// Invalid names each wrong member; Conflict: the vehicle's position is asked for and not known.
/// What the numbers mean together is judged by plan_survey.
base::Result<SurveyOrder> read_survey(const Json& body, const SurveyFacts& facts);

/// The figures, without the mission.
Json survey_json(const mission::Survey& survey);

}  // namespace roverd::api
