// SPDX-License-Identifier: Apache-2.0
// Signals that are false, then true for ever, added to an HDF5 file. Tested by
// tests/program/labels_back.py
#pragma once

#include <span>
#include <string>

namespace prehend::exchange {

struct Hdf5Signal {
  std::string dataset;       ///< its groups are made; a dataset of this name is replaced
  std::size_t first = 0;     ///< row that is true
  std::size_t rows = 0;      ///< of all
  bool as_integers = false;  ///< of 64 bits; else truth values, as h5py has them
};

/// Changes nothing else of the file, and adds no time of day. Returns "", or what went wrong.
std::string AddSignals(const std::string& path, std::span<const Hdf5Signal> signals);

}  // namespace prehend::exchange
