#pragma once

#include <memory>
#include <variant>

#include "server/api/call.hpp"
#include "server/net/router.hpp"

/// The handlers, one .cpp for each resource. What they may rely on stands in call.hpp.
namespace kinectlab::api {

// description.cpp
net::Response get_health(const Call& call);
net::Response get_description(const Call& call);

// session.cpp
net::Response post_session(const Call& call);
net::Response get_session(const Call& call);
net::Response delete_session(const Call& call);
net::Response put_password(const Call& call);

// users.cpp
net::Response get_users(const Call& call);
net::Response post_user(const Call& call);

// rigs.cpp
net::Response get_rigs(const Call& call);
net::Response get_rig(const Call& call);
net::Response get_camera_picture(const Call& call);
net::Response get_rig_bookings(const Call& call);

// live.cpp
net::Response post_live_ticket(const Call& call);
net::Upgraded open_live(const Call& call);

// experiments.cpp
net::Response get_experiments(const Call& call);
net::Response get_experiment(const Call& call);
net::Response get_definition_schema(const Call& call);
net::Response get_analyses(const Call& call);

// definitions.cpp
net::Response post_experiment(const Call& call);
net::Response put_experiment(const Call& call);
net::Response publish_experiment(const Call& call);
net::Response delete_experiment(const Call& call);
net::Response check_experiment(const Call& call);
net::Response try_experiment(const Call& call);

// bookings.cpp
net::Response get_bookings(const Call& call);
net::Response post_booking(const Call& call);
net::Response delete_booking(const Call& call);

// runs.cpp
net::Response get_runs(const Call& call);
net::Response post_run(const Call& call);
net::Response get_run(const Call& call);
net::Response post_release(const Call& call);
net::Response post_stop(const Call& call);
net::Response post_abort(const Call& call);

// run_data.cpp
net::Response get_poses(const Call& call);
net::Response get_poses_csv(const Call& call);
net::Response get_fit(const Call& call);
net::Response get_plots(const Call& call);
net::Response get_plot_picture(const Call& call);
net::Response get_report(const Call& call);

// results.cpp
net::Response get_results(const Call& call);
net::Response post_result(const Call& call);

}  // namespace kinectlab::api
