// SPDX-License-Identifier: Apache-2.0
// An episode as a film: a folder of frames, an animated WebP (by libwebp's img2webp), or what
// ffmpeg makes of them. Tested by tests/harness/show/pictures/film_test.cc and
// tests/program/render_test.cc
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/show/pictures/pictures.h"

namespace prehend::show {

/// More are refused: a frame takes a tenth of a second and more.
inline constexpr std::size_t kMostFrames = 3000;

struct FilmFormat {
  double from_s = 0, to_s = 1;  ///< of the episode
  double frames_per_s = 30;     ///< of the film
  double speed = 1;             ///< seconds of the episode in a second of the film
};

/// At which times of the episode frames are; at least one.
std::vector<double> FrameTimes(const FilmFormat& film);

/// Why these make no film, or "": "found 5000 frames, wanted at most 3000; ..".
std::string WhyTooLong(const FilmFormat& film);

/// Why there can be no film of this name, or "". A name without ending is a folder, which must be
/// new or empty.
std::string WhyNoFilm(const std::string& path);

/// Draws the film from `camera`. Returns "", or why there is none; then an older file is as it was.
std::string DrawFilm(const scenario::Scenario& scenario, const episode::RunResult& run,
                     const std::string& camera, const FilmFormat& film, const PictureFormat& format,
                     const std::string& path);

}  // namespace prehend::show
