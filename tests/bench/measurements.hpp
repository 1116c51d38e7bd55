#pragma once

#include <array>

#include "tests/bench/figure.hpp"

namespace kinectlab::bench {

Figures measure_frame_to_pose();
Figures measure_sphere_accuracy();
Figures measure_shape_regions();
Figures measure_shape_scene();
Figures measure_planes();
Figures measure_hough();
Figures measure_labelled_scenes();
Figures measure_outliers();
Figures measure_moving_least_squares();
Figures measure_normals();
Figures measure_octree_change();
Figures measure_organised_change();
Figures measure_median_reference();
Figures measure_depth_cut();
Figures measure_gravity_from_positions();
Figures measure_gravity_khoshelham();
Figures measure_gravity_kinect();
Figures measure_coverage();
Figures measure_coverage_bodies();
Figures measure_pendulum_coverage();
Figures measure_foucault_coverage();
Figures measure_arc_coverage();
Figures measure_pendulum_speed();
Figures measure_frames_pendulum();
Figures measure_frames_foucault();
Figures measure_frames_projectile();
Figures measure_frames_incline();
Figures measure_frames_spring();
Figures measure_frames_collision();
Figures measure_frames_robot();
Figures measure_frames_tumbler();
Figures measure_frames_arc();
Figures measure_frames_speed();
Figures measure_box_tracking();
Figures measure_recognition();
Figures measure_live_latency();
Figures measure_texture_pose();
Figures measure_sift3d_keypoints();
Figures measure_rendering();
Figures measure_colour_place();
Figures measure_identities();

/// Everything that can be measured. To add something: declare it above and name it here with the
/// figures it yields, so that --filter can pass over what is not wanted.
struct Measurement {
    const char* figures;
    Figures (*measure)();
};

inline constexpr std::array kMeasurements{
    Measurement{"depth frame to pose, stock chain", measure_frame_to_pose},
    Measurement{"sphere centre accuracy", measure_sphere_accuracy},
    Measurement{"sphere, cylinder, cone, region of interest", measure_shape_regions},
    Measurement{"whole scene, four kinds of shape", measure_shape_scene},
    Measurement{"plane, region of interest, under a ball", measure_planes},
    Measurement{"Hough transform in a scene", measure_hough},
    Measurement{"real labelled scenes, shapes", measure_labelled_scenes},
    Measurement{"outliers", measure_outliers},
    Measurement{"moving least squares", measure_moving_least_squares},
    Measurement{"normals", measure_normals},
    Measurement{"octree change", measure_octree_change},
    Measurement{"change in the image grid", measure_organised_change},
    Measurement{"reference, the median of seconds, rolling background", measure_median_reference},
    Measurement{"depth cut", measure_depth_cut},
    Measurement{"g, white positions, analysis of 900 positions", measure_gravity_from_positions},
    Measurement{"g, khoshelham noise", measure_gravity_khoshelham},
    Measurement{"g, kinect noise", measure_gravity_kinect},
    Measurement{"coverage, thrown rolling sliding ball, free driven spring", measure_coverage},
    Measurement{"coverage bodies: collision, rigid body, path", measure_coverage_bodies},
    Measurement{"coverage pendulum", measure_pendulum_coverage},
    Measurement{"coverage foucault", measure_foucault_coverage},
    Measurement{"coverage arc alone, 20°", measure_arc_coverage},
    Measurement{"coverage frames, pendulum", measure_frames_pendulum},
    Measurement{"coverage frames, foucault", measure_frames_foucault},
    Measurement{"coverage frames, projectile", measure_frames_projectile},
    Measurement{"coverage frames, incline", measure_frames_incline},
    Measurement{"coverage frames, spring", measure_frames_spring},
    Measurement{"coverage frames, collision", measure_frames_collision},
    Measurement{"coverage frames, robot", measure_frames_robot},
    Measurement{"coverage frames, tumbler", measure_frames_tumbler},
    Measurement{"coverage frames, arc alone at 20°", measure_frames_arc},
    Measurement{"analyse a run of 30 s from its poses", measure_pendulum_speed},
    Measurement{"analyse a run of 30 s from its frames", measure_frames_speed},
    Measurement{"box of 16x10x12 cm at 1.2 m", measure_box_tracking},
    Measurement{"recognition of a complex object", measure_recognition},
    Measurement{"live: capture to pose at a WebSocket client, frames lost", measure_live_latency},
    Measurement{"2-D texture pose, SIFT", measure_texture_pose},
    Measurement{"3-D SIFT keypoints", measure_sift3d_keypoints},
    Measurement{"rendering a rig", measure_rendering},
    Measurement{"colour: place, coverage", measure_colour_place},
    Measurement{"identities: names switched, fragments, IDF1", measure_identities},
};

}  // namespace kinectlab::bench
