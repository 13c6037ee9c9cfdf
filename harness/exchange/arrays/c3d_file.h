// SPDX-License-Identifier: Apache-2.0
// C3D files of markers (https://www.c3d.org): points and their labels, in integers or floating
// point, of Intel, MIPS and DEC processors. Analog channels, forces and events are not read. Tested
// by tests/program/import_markers.py
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace prehend::exchange {

class C3dFile {
 public:
  /// Takes the whole file. Returns what is wrong, with the byte at which it was seen, or "".
  std::string Load(std::string bytes);

  std::vector<std::string> labels;  ///< of each point; "*17": it has none
  std::size_t frames = 0;
  double rate_hz = 0;
  std::string unit;                ///< "mm"; "": not said
  std::vector<std::string> notes;  ///< what is not read

  /// None: not seen.
  std::optional<Eigen::Vector3d> At(std::size_t frame, std::size_t point) const;

 private:
  enum class Processor { kIntel = 84, kDec = 85, kMips = 86 };
  /// A value of the parameter section: numbers, or texts.
  struct Parameter {
    std::vector<double> numbers;
    std::vector<std::string> texts;
  };

  std::uint16_t Word(std::size_t at) const;
  double Real(std::size_t at) const;
  std::string LoadParameters(std::size_t at, std::size_t end);
  std::string TakeParameter(const std::string& name, std::size_t at, std::size_t end);
  double NumberOf(const std::string& parameter, double otherwise) const;
  void TakeLabels(std::size_t points);
  std::size_t FramesSaid() const;

  std::string bytes_;
  Processor processor_ = Processor::kIntel;
  std::map<std::string, Parameter> parameters_;  ///< "POINT:LABELS"
  std::size_t data_at_ = 0, frame_bytes_ = 0, points_ = 0;
  double scale_ = 1;
  bool is_real_ = false;
};

}  // namespace prehend::exchange
