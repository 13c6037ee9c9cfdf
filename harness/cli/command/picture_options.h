// SPDX-License-Identifier: Apache-2.0
// Options of all commands that draw: what of an episode, from where, how. Tested by
// tests/program/render_test.cc and tests/program/figure_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/cli/command/command.h"
#include "harness/show/figures/scene_tiles.h"
#include "harness/show/pictures/pictures.h"

namespace prehend::cli {

/// --from, --to, --hand, --of.
std::vector<Option> PartOptions();
/// --camera, --text, --look.
std::vector<Option> LookOptions();
/// --width, of drawings.
Option WidthOption();
/// Of a PNG for each of the drawing's.
double PixelsOf(const ParsedOptions& options);

/// What these options say; the rest is as of a picture.
show::PictureFormat FormatOfOptions(const ParsedOptions& options);

/// What is wrong with the part, or "": an empty time, a hand or a thing that the scenario does not
/// have.
std::string WhyNoPart(const show::PictureFormat& format, const scenario::Scenario& scenario);

/// The same for figures, and what is wrong with a window that begins after the run, or with
/// --camera.
std::string WhyNotShown(const ParsedOptions& options, const scenario::Scenario& scenario,
                        const episode::RunResult& run);
show::Window WindowOf(const ParsedOptions& options, const episode::RunResult& run);
/// `camera`: unless another one is asked for; `width_px`: of the drawing.
show::SceneFormat SceneFormatOf(const ParsedOptions& options, const std::string& camera,
                                double width_px);

}  // namespace prehend::cli
