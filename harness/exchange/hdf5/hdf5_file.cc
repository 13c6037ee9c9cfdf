// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/hdf5/hdf5_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <regex>
#include <string_view>

#include "harness/base/base/input_files.h"
#include "harness/base/base/text_file.h"

namespace prehend::exchange {
namespace {

using grammar::Diagnostics;

/// Before anything else of the library: no messages of its own, no plugins, no other files.
void SetUp() {
  static const bool done = [] {
    H5open();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    H5PLset_loading_state(0);
    H5Lunregister(H5L_TYPE_EXTERNAL);
    return true;
  }();
  static_cast<void>(done);
}

/// The library never leaves a heap of no size: a call that takes longer ends the process.
class WithinTime {
 public:
  WithinTime() {
    sigevent event = {};
    event.sigev_notify = SIGEV_SIGNAL;
    event.sigev_signo = SIGXCPU;
    const itimerspec at_most = {.it_interval = {}, .it_value = {.tv_sec = 20, .tv_nsec = 0}};
    is_made_ = timer_create(CLOCK_THREAD_CPUTIME_ID, &event, &timer_) == 0;
    if (is_made_) timer_settime(timer_, 0, &at_most, nullptr);
  }
  WithinTime(const WithinTime&) = delete;
  ~WithinTime() {
    if (is_made_) timer_delete(timer_);
  }

 private:
  timer_t timer_ = {};
  bool is_made_ = false;
};

/// What the library found wrong last, where it began.
std::string InnermostError() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned n, const H5E_error2_t* error, void* to) -> herr_t {
        if (n == 0 && error->desc) *static_cast<std::string*>(to) = error->desc;
        return 0;
      },
      &text);
  return ReadableName(text.substr(0, 200));
}

/// Only types that are numbers of this kind bit by bit: one that a stranger made up is other.
Hdf5Kind KindOf(hid_t type) {
  const H5T_class_t one = H5Tget_class(type);
  if (one == H5T_STRING) return Hdf5Kind::kText;
  if (one == H5T_ENUM) {
    std::int8_t no = 1, yes = 0;
    const bool two = H5Tget_size(type) == 1 && H5Tget_nmembers(type) == 2 &&
                     H5Tenum_valueof(type, "FALSE", &no) >= 0 &&
                     H5Tenum_valueof(type, "TRUE", &yes) >= 0;
    return two && no == 0 && yes == 1 ? Hdf5Kind::kBool : Hdf5Kind::kOther;
  }
  const auto is = [&](std::initializer_list<hid_t> known) {
    return std::ranges::any_of(known, [&](hid_t other) { return H5Tequal(type, other) > 0; });
  };
  if (is({H5T_IEEE_F32LE, H5T_IEEE_F64LE, H5T_IEEE_F32BE, H5T_IEEE_F64BE})) return Hdf5Kind::kFloat;
  if (is({H5T_STD_I64LE, H5T_STD_I32LE, H5T_STD_I16LE, H5T_STD_I8LE, H5T_STD_U64LE, H5T_STD_U32LE,
          H5T_STD_U16LE, H5T_STD_U8LE, H5T_STD_I64BE, H5T_STD_I32BE, H5T_STD_I16BE, H5T_STD_U64BE,
          H5T_STD_U32BE, H5T_STD_U16BE}))
    return Hdf5Kind::kInteger;
  return Hdf5Kind::kOther;
}

/// Numbers are compared as such: demo_2 comes before demo_10.
bool ComesBefore(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  const auto digits = [](const std::string& text, std::size_t at) {
    return std::min(text.find_first_not_of("0123456789", at), text.size()) - at;
  };
  while (i < a.size() && j < b.size()) {
    const std::size_t of_a = digits(a, i), of_b = digits(b, j);
    if (of_a == 0 || of_b == 0) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    const std::string_view x = std::string_view(a).substr(i, of_a),
                           y = std::string_view(b).substr(j, of_b);
    if (of_a != of_b) return of_a < of_b;
    if (x != y) return x < y;
    i += of_a, j += of_b;
  }
  return a.size() - i < b.size() - j;
}

/// The number and the name of one of its filters.
std::pair<H5Z_filter_t, std::string> FilterOf(hid_t plist, int i) {
  unsigned flags = 0;
  std::size_t values = 0;
  char name[40] = {};
  const H5Z_filter_t filter = H5Pget_filter2(plist, static_cast<unsigned>(i), &flags, &values,
                                             nullptr, sizeof name, name, nullptr);
  return {filter, ReadableName({name, strnlen(name, sizeof name)})};
}

/// Why a dataset is not read, or "": it leads elsewhere, or costs more than it should.
std::string Refusal(hid_t dataset) {
  const Hdf5Id plist(H5Dget_create_plist(dataset));
  if (!plist) return "its properties are damaged";
  const H5D_layout_t layout = H5Pget_layout(plist);
  if (layout == H5D_VIRTUAL) return "is a virtual dataset, of other files";
  if (H5Pget_external_count(plist) != 0) return "has its data in other files";
  for (int i = 0; i < H5Pget_nfilters(plist); ++i) {
    const auto [filter, name] = FilterOf(plist, i);
    if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE)
      return fmt::format(
          "is compressed by '{}' (filter {}); gzip and shuffle are read: h5repack -f GZIP=4 IN OUT",
          name, filter);
  }
  return "";
}

/// HDF5 1.10 reads beyond the end of a chunk that is shorter than it should be: "", or why not.
std::string ChunkProblem(hid_t dataset, const Hdf5Object& object) {
  const Hdf5Id plist(H5Dget_create_plist(dataset));
  if (H5Pget_layout(plist) != H5D_CHUNKED || object.shape.empty()) return "";
  const std::vector<hsize_t> shape(object.shape.begin(), object.shape.end());
  std::vector<hsize_t> chunk(shape.size(), 0), at(shape.size(), 0);
  H5Pget_chunk(plist, static_cast<int>(chunk.size()), chunk.data());
  std::size_t bytes = static_cast<std::size_t>(object.bytes);
  for (const hsize_t size : chunk) {
    if (size == 0 || size > kMostHdf5ChunkBytes / bytes)
      return fmt::format("has chunks of more than {} bytes", kMostHdf5ChunkBytes);
    bytes *= size;
  }
  int deflates = -1;  // which of its filters
  for (int i = 0; i < H5Pget_nfilters(plist); ++i)
    if (FilterOf(plist, i).first == H5Z_FILTER_DEFLATE) deflates = i;
  for (std::size_t i = 0; i < kMostHdf5Names; ++i) {
    unsigned mask = 0;
    haddr_t address = 0;
    hsize_t stored = 0;
    if (H5Dget_chunk_info_by_coord(dataset, at.data(), &mask, &address, &stored) < 0)
      return "is damaged: " + InnermostError();
    uLongf size = stored;
    if (deflates >= 0 && (mask >> deflates & 1) == 0 && stored <= 2 * bytes + 1024) {
      std::vector<Bytef> packed(stored), whole(size = bytes);
      if (H5Dread_chunk(dataset, H5P_DEFAULT, at.data(), &mask, packed.data()) < 0 ||
          uncompress(whole.data(), &size, packed.data(), stored) != Z_OK)
        size = 0;
    }
    if (address != HADDR_UNDEF && size != bytes)
      return "is damaged: a chunk is not as long as it should be";
    std::size_t k = at.size();
    while (k-- > 0 && (at[k] += chunk[k]) >= shape[k]) at[k] = 0;
    if (k == SIZE_MAX) return "";
  }
  return fmt::format("has more than {} chunks", kMostHdf5Names);
}

/// A dataset that may be read.
Hdf5Object ObjectOf(hid_t dataset) {
  const Hdf5Id type(H5Dget_type(dataset)), space(H5Dget_space(dataset));
  std::vector<hsize_t> shape(
      static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return {.name = {},
          .kind = KindOf(type),
          .bytes = static_cast<int>(std::max<std::size_t>(1, H5Tget_size(type))),
          .shape = {shape.begin(), shape.end()},
          .is_unsigned = KindOf(type) == Hdf5Kind::kInteger && H5Tget_sign(type) == H5T_SGN_NONE};
}

/// `read`: one text of `type`, as H5Aread does.
template <typename Read>
std::string TextIn(hid_t type, const Read& read) {
  const Hdf5Id memory(H5Tcopy(type));
  if (H5Tis_variable_str(type) > 0) {
    char* text = nullptr;
    if (read(memory, &text) < 0 || !text) return "";
    const std::string copy(text, strnlen(text, kMostHdf5TextBytes));
    H5free_memory(text);
    return copy;
  }
  const std::size_t size = H5Tget_size(type);
  if (size > kMostHdf5TextBytes) return "";
  std::string text(size, '\0');
  if (read(memory, text.data()) < 0) return "";
  return text.substr(0, text.find('\0'));
}

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

Hdf5Id::~Hdf5Id() {
  if (id_ >= 0) H5Idec_ref(id_);
}

std::uint64_t Hdf5Object::Width() const {
  std::uint64_t width = 1;
  for (std::size_t i = 1; i < shape.size(); ++i) width *= shape[i];
  return width;
}

std::string Hdf5Object::Text() const {
  constexpr std::array kNames = {"group", "float", "int", "bool", "text", "of another type"};
  const std::string type = kNames[static_cast<std::size_t>(kind)];
  if (kind == Hdf5Kind::kGroup) return type;
  const bool sized = kind == Hdf5Kind::kFloat || kind == Hdf5Kind::kInteger;
  return fmt::format("({}{}) {}{}{}", fmt::join(shape, ", "), shape.size() == 1 ? "," : "",
                     is_unsigned ? "u" : "", type, sized ? std::to_string(8 * bytes) : "");
}

Result<Hdf5File> Hdf5File::Open(const std::string& path) {
  const WithinTime within_time;
  SetUp();
  Hdf5File file;
  file.path_ = path;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    return tl::unexpected(file.Error(std::filesystem::exists(path, error)
                                         ? "it is a folder or a device; expected an HDF5 file"
                                         : "it does not exist, or cannot be read"));
  RememberInput(path);
  const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_file_locking(access, true, true);
  file.file_ = Hdf5Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access));
  if (file.file_) return file;
  const std::string why = InnermostError();
  const bool cut = why.find("truncated") != std::string::npos;
  return tl::unexpected(file.Error(
      cut ? "the file is cut off (" + why + ")" : "it is no HDF5 file, or is damaged: " + why,
      cut ? "was it copied whole, and closed by the program that wrote it?" : ""));
}

Diagnostics Hdf5File::Error(std::string message, std::string hint) const {
  return {{.file = ReadableName(path_), .message = std::move(message), .hint = std::move(hint)}};
}

Result<Hdf5Id> Hdf5File::OpenObject(const std::string& path) const {
  const WithinTime within_time;
  Hdf5Id object(H5Oopen(file_, path.empty() ? "/" : path.c_str(), H5P_DEFAULT));
  if (!object) return tl::unexpected(WhyNotOpened(path));
  const H5I_type_t type = H5Iget_type(object);
  if (type == H5I_DATASET) {
    if (const std::string why = Refusal(object); !why.empty())
      return tl::unexpected(Error(fmt::format("'{}' {}", path, why)));
  } else if (type != H5I_GROUP) {
    return tl::unexpected(Error(fmt::format("'{}' is neither a group nor a dataset", path)));
  }
  return object;
}

Diagnostics Hdf5File::WhyNotOpened(const std::string& path) const {
  std::string damage = InnermostError(), before = "/";
  for (std::size_t end = 0; end < path.size();) {
    end = path.find('/', end + 1);
    const std::string part = path.substr(0, end);
    H5L_info_t info;
    if (H5Lexists(file_, part.c_str(), H5P_DEFAULT) > 0 &&
        H5Lget_info(file_, part.c_str(), &info, H5P_DEFAULT) >= 0) {
      if (info.type != H5L_TYPE_HARD && H5Oexists_by_name(file_, part.c_str(), H5P_DEFAULT) <= 0)
        return Error(fmt::format("'{}' is a link {}", part,
                                 info.type == H5L_TYPE_SOFT
                                     ? "to nothing in this file"
                                     : "to another file, which is not read"));
      before = part;
      continue;
    }
    if (!Has(before)) break;  // or this would be asked of it again, without end
    const Result<std::vector<std::string>> names = NamesIn(before);
    if (!names) break;
    const std::string name = part.substr(part.rfind('/') + 1);
    if (std::ranges::find(*names, name) != names->end()) break;
    const std::string nearest = grammar::NearestName(name, *names);
    const auto end_of_list = names->begin() + std::min<std::ptrdiff_t>(12, std::ssize(*names));
    return Error(fmt::format("'{}' is not in the file: '{}' has {}{}", part, before,
                             fmt::join(names->begin(), end_of_list, ", "),
                             end_of_list != names->end() ? " .." : ""),
                 nearest.empty() ? "" : fmt::format("did you mean '{}'?", nearest));
  }
  return Error(fmt::format("'{}' is damaged: {}", path, damage));
}

bool Hdf5File::Has(const std::string& object) const {
  const Hdf5Id opened(H5Oopen(file_, object.empty() ? "/" : object.c_str(), H5P_DEFAULT));
  return static_cast<bool>(opened);
}

Result<Hdf5Object> Hdf5File::Describe(const std::string& path) const {
  const WithinTime within_time;
  PREHEND_TRY(const Hdf5Id object, OpenObject(path));
  Hdf5Object description;
  description.kind = Hdf5Kind::kGroup;
  if (H5Iget_type(object) == H5I_DATASET) description = ObjectOf(object);
  description.name = path.substr(path.rfind('/') + 1);
  return description;
}

Result<std::vector<std::string>> Hdf5File::NamesIn(const std::string& path) const {
  const WithinTime within_time;
  PREHEND_TRY(const Hdf5Id group, OpenObject(path));
  if (H5Iget_type(group) != H5I_GROUP)
    return tl::unexpected(Error(fmt::format("'{}' is a dataset; expected a group", path)));
  std::vector<std::string> names;
  const herr_t status = H5Literate(
      group, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
        auto& all = *static_cast<std::vector<std::string>*>(to);
        all.emplace_back(name);
        return all.size() > kMostHdf5Names ? 1 : 0;
      },
      &names);
  if (status < 0)
    return tl::unexpected(Error(fmt::format("'{}' is damaged: {}", path, InnermostError())));
  if (status > 0)
    return tl::unexpected(
        Error(fmt::format("'{}' has more than {} members", path, kMostHdf5Names)));
  std::ranges::sort(names, ComesBefore);
  return names;
}

std::optional<Hdf5Value> Hdf5File::Attribute(const std::string& path,
                                             const std::string& name) const {
  const WithinTime within_time;
  const Result<Hdf5Id> object = OpenObject(path);
  if (!object || H5Aexists(*object, name.c_str()) <= 0) return std::nullopt;
  const Hdf5Id attribute(H5Aopen(*object, name.c_str(), H5P_DEFAULT));
  if (!attribute) return std::nullopt;
  const Hdf5Id type(H5Aget_type(attribute)), space(H5Aget_space(attribute));
  if (!type || !space || H5Sget_simple_extent_npoints(space) != 1) return std::nullopt;
  const Hdf5Kind kind = KindOf(type);
  if (kind == Hdf5Kind::kText)
    return TextIn(type, [&](hid_t as, void* to) { return H5Aread(attribute, as, to); });
  std::int8_t flag = 0;
  double value = 0;
  const bool is_bool = kind == Hdf5Kind::kBool;
  if (!is_bool && kind != Hdf5Kind::kFloat && kind != Hdf5Kind::kInteger) return std::nullopt;
  if ((is_bool ? H5Aread(attribute, type, &flag) : H5Aread(attribute, H5T_NATIVE_DOUBLE, &value)) <
      0)
    return std::nullopt;
  return is_bool ? flag : value;
}

std::optional<std::string> Hdf5File::LastText(const std::string& path) const {
  const WithinTime within_time;
  const Result<Hdf5Id> dataset = OpenObject(path);
  if (!dataset || H5Iget_type(*dataset) != H5I_DATASET) return std::nullopt;
  const Hdf5Object object = ObjectOf(*dataset);
  if (object.kind != Hdf5Kind::kText || object.Rows() * object.Width() == 0 ||
      !ChunkProblem(*dataset, object).empty())
    return std::nullopt;
  const Hdf5Id type(H5Dget_type(*dataset)), last(H5Dget_space(*dataset)),
      one(H5Screate(H5S_SCALAR));
  std::vector<hsize_t> at(object.shape.begin(), object.shape.end());
  for (hsize_t& of : at) --of;
  if (!at.empty() && H5Sselect_elements(last, H5S_SELECT_SET, 1, at.data()) < 0)
    return std::nullopt;
  return TextIn(
      type, [&](hid_t as, void* to) { return H5Dread(*dataset, as, one, last, H5P_DEFAULT, to); });
}

Result<std::vector<double>> Hdf5File::Read(const std::string& path, const Hdf5Part& part) const {
  const WithinTime within_time;
  PREHEND_TRY(const Hdf5Id dataset, OpenObject(path));
  const auto refuse = [&](const std::string& why) {
    return tl::unexpected(Error(fmt::format("'{}' {}", path, why)));
  };
  if (H5Iget_type(dataset) != H5I_DATASET) return refuse("is a group; expected a dataset");
  const Hdf5Object object = ObjectOf(dataset);
  const bool is_bool = object.kind == Hdf5Kind::kBool;
  if (!is_bool && object.kind != Hdf5Kind::kFloat && object.kind != Hdf5Kind::kInteger)
    return refuse(fmt::format("is {}; expected numbers", object.Text()));
  const std::uint64_t rows = object.Rows(), width = object.Width();
  if (width > kMostHdf5Values || rows > kMostHdf5Values / std::max<std::uint64_t>(width, 1))
    return refuse(fmt::format("is {}; at most {} values are read", object.Text(), kMostHdf5Values));
  if (const std::string why = ChunkProblem(dataset, object); !why.empty()) return refuse(why);
  const Hdf5Id type(H5Dget_type(dataset));
  std::vector<double> values(rows * width);
  std::vector<std::int8_t> flags(is_bool ? values.size() : 0);
  const hid_t as = is_bool ? static_cast<hid_t>(type) : H5T_NATIVE_DOUBLE;
  void* const to = is_bool ? static_cast<void*>(flags.data()) : values.data();
  if (!values.empty() && H5Dread(dataset, as, H5S_ALL, H5S_ALL, H5P_DEFAULT, to) < 0)
    return refuse("is damaged: " + InnermostError());
  std::ranges::copy(flags, values.begin());
  const std::uint64_t from = std::min(part.first, width),
                      columns = std::min(part.count, width - from);
  for (std::uint64_t row = 0; columns < width && row < rows; ++row)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row * width + from), columns,
                values.begin() + static_cast<std::ptrdiff_t>(row * columns));
  values.resize(rows * columns);
  return values;
}

std::optional<Hdf5Part> Hdf5PartOf(const std::string& text) {
  static const std::regex kPart(R"(([^\[\]/][^\[\]]*)(?:\[(\d{1,6})(?::(\d{1,6}))?\])?)");
  std::smatch match;
  if (text.size() > 500 || !std::regex_match(text, match, kPart)) return std::nullopt;
  if (!match[2].matched) return Hdf5Part{.dataset = match[1]};
  const std::uint64_t first = std::stoull(match[2]),
                      end = match[3].matched ? std::stoull(match[3]) : first + 1;
  if (end <= first) return std::nullopt;
  return Hdf5Part{.dataset = match[1], .first = first, .count = end - first};
}

std::string AddSignals(const std::string& path, std::span<const Hdf5Signal> signals) {
  const WithinTime within_time;
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
