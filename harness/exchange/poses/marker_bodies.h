// SPDX-License-Identifier: Apache-2.0
// Bodies made of markers: the rigid motion that moves their shape nearest to where they were seen,
// least squares, in each frame. Tested by tests/program/import_markers.py
#pragma once

#include "harness/exchange/poses/pose_file.h"

namespace prehend::exchange {

/// The markers of the map, without positions, each once.
std::vector<PoseBody> MarkersOf(const ImportMap& map);

/// Poses of the bodies of the map that have markers, from `poses.markers`. Their origin is the mean
/// of the markers; x points from the first to the second of them. Frames in which they are farther
/// off their shape than the map allows have no pose, and are named.
void ComposeMarkers(const ImportMap& map, PoseFile& poses, DiagnosticList& errors);

/// Counts poses whose error, as the tracker says, is more than the map allows.
struct MarkerErrors {
  std::size_t count = 0, of = 0;
  double most = 0, most_s = 0;  ///< in the file's unit
  int line = 0;

  /// False: it is too large.
  bool Take(double error, double limit, double t_s, int line_of_file);
  /// "'Cup': 3 of 301 poses ..", or "".
  std::string Text(const std::string& body, const std::string& what, const std::string& file,
                   double metres_per_unit, double limit_m) const;
};

}  // namespace prehend::exchange
