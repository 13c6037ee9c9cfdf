// SPDX-License-Identifier: Apache-2.0
// What a picture shows of a scene besides what happens: colours, legs of furniture, where persons
// look, and which persons stand in the way of the view. Tested by
// tests/harness/show/pictures/scenery_test.cc
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/episode/run/run_scenario.h"
#include "harness/scenario/scenario/scenario.h"
#include "harness/show/pictures/pictures.h"
#include "render/picture.h"

namespace prehend::show {

/// 0xRRGGBB.
render::Color ColorOf(std::uint32_t rgb);

/// Cameras and lights are not in the picture.
bool IsSeen(const physics::Body& body);

/// One per scene body: what `color` says, else a colour word in the name, else the class, else one
/// of a palette by index.
std::vector<render::Color> BodyColors(const scenario::Scenario& scenario);

/// Per scene hand the colours of its palm and links by the sets of their sensors; empty without
/// any.
std::vector<std::vector<render::Color>> SensorColors(
    const physics::Scene& scene, const std::map<std::string, std::uint32_t>& color_of_set);

/// What fixed things stand on that nothing carries: legs, or near to the floor at z = 0 a plinth.
std::vector<render::Prop> LegsOf(const scenario::Scenario& scenario,
                                 const std::vector<render::Color>& colors,
                                 const physics::Snapshot& now);

/// A ray from the eyes of each person to what she sees.
std::vector<render::GazeRay> GazesOf(const physics::Scene& scene, const physics::Snapshot& now);

/// One per scene body: less than 1 for the parts of a person that hide a hand, what is touched, or
/// what moves from the eye of the camera.
std::vector<float> BodyAlphas(const physics::Scene& scene, const physics::Snapshot& now,
                              const Eigen::Vector3f& eye_m);

/// Direction from the middle of the things to the first light; nullopt without a light.
std::optional<Eigen::Vector3f> ToLight(const physics::Scene& scene);

/// Of each phase at the moment of `now`: the regions of its rule in the colour of the phase, and a
/// star above each movable thing that is in a region in front of a hand. `shown` says which events
/// the picture shows.
std::vector<render::Marker> RegionMarkers(
    const scenario::Scenario& scenario, const episode::RunResult& run, const physics::Snapshot& now,
    const std::function<bool(const grammar::NamedEvent&)>& shown);

// Composes a render::Picture of a recorded run at one moment: camera, colours, paths, ghosts,
// markers, and the rows of the strip. Tested by tests/harness/show/pictures/compose_picture_test.cc

/// The recording must not be empty. The scenario must outlive the picture.
render::Picture ComposePicture(const scenario::Scenario& scenario, const episode::RunResult& run,
                               const scenario::PictureYaml& entry,
                               const PictureFormat& format = {});

/// Draws as the format says; a transparent ground is found by drawing on white and on black paper.
/// An empty image on failure; the painter then has the reason.
render::Image DrawImage(render::Painter& painter, const render::Picture& picture,
                        const PictureFormat& format);

/// The first picture in pale grey, with every pixel in red that differs. Both have one size.
render::Image PaleWithRed(const render::Image& first, const render::Image& second);

// From where a picture is seen. A camera is fitted to the whole episode, not to the moment, so that
// pictures of one scenario can be laid over each other.

/// `name` is one of CamerasOf(): a camera of the scenario, or
///  - front, left, right, top, three_quarter: hands, small things and what moves, all the time;
///    top also what these stand on;
///  - action: hands, and small things that move, all the time;
///  - body: persons, too;
///  - hand: the hands as they are in the picture's snapshot, what is near them, and
///  `format.framed`.
///    Where that names hands, other hands are left out;
///  - a place and where it looks (harness/scenario/scenario/scenario.h).
render::Camera CameraFor(const scenario::Scenario& scenario, const episode::RunResult& run,
                         const render::Picture& picture, const std::string& name,
                         const PictureFormat& format = {});

}  // namespace prehend::show
