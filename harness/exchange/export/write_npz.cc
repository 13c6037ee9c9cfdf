// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/export/motion.h: a zip file of arrays of NumPy (.npy, version 1.0),
// stored as they are. Tested by tests/program/exported.py
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <limits>

#include "grammar/base/frame.h"
#include "harness/exchange/export/byte_writer.h"
#include "harness/exchange/export/motion.h"

namespace prehend::exchange {
namespace {

class NpzFile {
 public:
  explicit NpzFile(std::ostream& out) : out_(out) {}

  void Add(const std::string& name, const std::string& shape, const std::string& type,
           const std::string& data) {
    std::string header =
        fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
    header.resize((header.size() + 11 + 63) / 64 * 64 - 11, ' ');
    ByteWriter array{.bytes = std::string("\x93NUMPY\x01\x00", 8)};
    array.U16(header.size() + 1).bytes += header + "\n" + data;
    const auto* bytes = reinterpret_cast<const Bytef*>(array.bytes.data());
    ByteWriter about;  // no flags, stored, 1 January 1980
    about.U16(20).U16(0).U16(0).U16(0).U16(33).U32(crc32_z(0, bytes, array.bytes.size()));
    about.U32(array.bytes.size()).U32(array.bytes.size()).U16(name.size() + 4).U16(0);
    ByteWriter entry;
    entry.U32(0x02014b50).U16(20).bytes += about.bytes;
    entry.U16(0).U16(0).U16(0).U32(0).U32(at_).bytes += name + ".npy";
    directory_ += entry.bytes;
    ++count_;
    Put(ByteWriter{}.U32(0x04034b50).bytes + about.bytes + name + ".npy" + array.bytes);
  }

  /// Rows of numbers.
  void Add(const std::string& name, const std::string& shape, const std::vector<double>& values) {
    Add(name, shape, "<f8",
        std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)));
  }

  /// UTF-8 texts, as bytes of one length.
  void Add(const std::string& name, const std::vector<std::string>& texts) {
    std::size_t longest = 1;
    for (const std::string& text : texts) longest = std::max(longest, text.size());
    std::string data;
    for (const std::string& text : texts) data += text + std::string(longest - text.size(), '\0');
    Add(name, fmt::format("{},", texts.size()), fmt::format("|S{}", longest), data);
  }

  void Finish() {
    const std::uint64_t begin = at_;
    ByteWriter end{.bytes = directory_};
    end.U32(0x06054b50).U16(0).U16(0).U16(count_).U16(count_).U32(directory_.size()).U32(begin);
    Put(end.U16(0).bytes);
  }

 private:
  void Put(const std::string& bytes) {
    out_ << bytes;
    at_ += bytes.size();
  }

  std::ostream& out_;
  std::uint64_t at_ = 0;
  std::size_t count_ = 0;
  std::string directory_;
};

}  // namespace

void WriteNpz(const Motion& motion, std::ostream& out) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const std::size_t count = motion.seen.size();
  std::vector<double> t, p, q, grip, joint, begin, end;
  motion.EachFrame([&](const grammar::Frame& frame) {
    t.push_back(motion.Seconds(frame.tick));
    for (const grammar::EntitySample& look : frame.entities) {
      const bool known = grammar::IsTracked(look);
      for (int i = 0; i < 3; ++i) p.push_back(known ? look.p_WB_m[i] : kNone);
      for (const int i : {3, 0, 1, 2}) q.push_back(known ? look.q_WB.coeffs()[i] : kNone);
      joint.push_back(look.joint_position);
    }
    grip.resize(t.size() * count, kNone);
    for (const grammar::HandSample& hand : frame.hands)
      grip[grip.size() - count + static_cast<std::size_t>(hand.entity)] = hand.trigger;
  });
  std::vector<std::string> names, classes, events, roles;
  std::string open;
  for (const grammar::EntityInfo& entity : motion.table().entities) {
    names.push_back(entity.name);
    classes.push_back(entity.classes.front());
  }
  for (const grammar::NamedEvent& event : motion.timeline.events) {
    events.push_back(event.event);
    roles.push_back(RolesJson(event));
    begin.push_back(motion.Seconds(event.interval.begin));
    end.push_back(motion.Seconds(event.interval.end));
    open += event.open_end ? '\1' : '\0';
  }
  const std::string rows = fmt::format("{},", t.size()), cells = rows + fmt::format("{},", count),
                    of_events = fmt::format("{},", events.size());
  NpzFile file(out);
  file.Add("t_s", rows, t);
  file.Add("position_m", cells + "3", p);
  file.Add("quaternion_wxyz", cells + "4", q);
  file.Add("grip", cells, grip);
  file.Add("joint_position", cells, joint);
  file.Add("entity", names);
  file.Add("class", classes);
  file.Add("event", events);
  file.Add("event_uuid", motion.uuids);
  file.Add("event_begin_s", of_events, begin);
  file.Add("event_end_s", of_events, end);
  file.Add("event_open_end", of_events, "|b1", open);
  file.Add("event_roles_json", roles);
  file.Finish();
}

}  // namespace prehend::exchange
