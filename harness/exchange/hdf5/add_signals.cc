// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/hdf5/add_signals.h. Tested by tests/program/labels_back.py
#include "harness/exchange/hdf5/add_signals.h"

#include <hdf5.h>

#include <vector>

#include "harness/exchange/hdf5/hdf5_file.h"

namespace prehend::exchange {
namespace {

Hdf5Id TruthType() {
  Hdf5Id type(H5Tenum_create(H5T_STD_I8LE));
  for (const std::int8_t value : {0, 1}) H5Tenum_insert(type, value ? "TRUE" : "FALSE", &value);
  return type;
}

bool AddSignal(hid_t file, const Hdf5Signal& signal) {
  const Hdf5Id links(H5Pcreate(H5P_LINK_CREATE)), how(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_create_intermediate_group(links, 1);
  H5Pset_obj_track_times(how, false);
  const hsize_t rows = signal.rows;
  const Hdf5Id space(H5Screate_simple(1, &rows, nullptr)),
      type(signal.as_integers ? Hdf5Id(H5Tcopy(H5T_STD_I64LE)) : TruthType());
  const Hdf5Id old(H5Oopen(file, signal.dataset.c_str(), H5P_DEFAULT));
  if (old && H5Ldelete(file, signal.dataset.c_str(), H5P_DEFAULT) < 0) return false;
  const Hdf5Id set(H5Dcreate2(file, signal.dataset.c_str(), type, space, links, how, H5P_DEFAULT));
  if (!set) return false;
  std::vector<std::int64_t> integers;
  std::vector<std::int8_t> truths;
  for (std::size_t i = 0; i < signal.rows; ++i) {
    integers.push_back(i >= signal.first);
    truths.push_back(i >= signal.first);
  }
  const void* const values = signal.as_integers ? static_cast<const void*>(integers.data())
                                                : static_cast<const void*>(truths.data());
  return H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
}

}  // namespace

std::string AddSignals(const std::string& path, std::span<const Hdf5Signal> signals) {
  if (const Result<Hdf5File> readable = Hdf5File::Open(path); !readable)
    return readable.error().front().message;
  Hdf5Id file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
  if (!file) return "the copy cannot be opened for writing";
  for (const Hdf5Signal& signal : signals) {
    if (!AddSignal(file, signal)) return "'" + signal.dataset + "' cannot be written";
  }
  return H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 ? "the copy cannot be written" : "";
}

}  // namespace prehend::exchange
