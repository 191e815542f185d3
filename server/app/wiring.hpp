#pragma once
// What the station is put together from: settings as the rooms want them, and net's callables as
// api knows them.

#include <string>

#include "api/api.hpp"
#include "app/front.hpp"
#include "app/recordings.hpp"
#include "config/settings.hpp"
#include "net/hub.hpp"
#include "net/server.hpp"
#include "supervise/supervisor.hpp"

namespace roverd {

/// The link that moves the robot; empty: none does.
std::string drive_link(const Settings& s);
RecordingBounds bounds_of(const RecordingSettings& recording);
/// Who learned something. The simulated robot is not the real one: they differ in the link that
/// moves them.
std::string learner(const Settings& s);
api::Profile profile_of(const Settings& s, const Supervisor& supervisor);
/// net's hub behind the callables that api knows. Both must outlive what is made here.
api::Stream stream_of(net::Hub& hub);
/// @param front null: no TLS
net::Handlers handlers_of(api::Api& api, const Front* front);

}  // namespace roverd
