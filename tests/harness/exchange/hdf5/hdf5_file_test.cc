// SPDX-License-Identifier: Apache-2.0
// Tests of harness/exchange/hdf5: what h5py writes is read; what leads out of the file, or costs
// more than it should, is not.
#include "harness/exchange/hdf5/hdf5_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace prehend::exchange {
namespace {

using Numbers = std::vector<double>;

const char* const kWriter = R"(
import h5py, numpy as np, os, sys, zlib
os.chdir(sys.argv[1])
with h5py.File('other.hdf5', 'w') as f: f['secret'] = np.arange(3.0)
open('raw.bin', 'wb').write(bytes(24))
layout = h5py.VirtualLayout(shape=(3,), dtype='f8')
layout[:] = h5py.VirtualSource('other.hdf5', 'secret', shape=(3,))
with h5py.File('a.hdf5', 'w') as f:
  d = f.create_group('data')
  d.attrs['env_args'] = '{"env_name": "stack"}'
  d.attrs['fixed'] = np.bytes_('plain')
  d.attrs['total'] = np.int64(7)
  for name in ('demo_10', 'demo_2', 'demo_0'): d.create_group(name).attrs['success'] = np.bool_(name == 'demo_2')
  g = f['data/demo_2']
  g['f4'] = np.arange(12, dtype='f4').reshape(4, 3)
  g['be'] = np.arange(4, dtype='>f8')
  g.create_dataset('zipped', data=np.arange(1000).reshape(250, 4), compression='gzip', shuffle=True, chunks=(100, 4))
  g['flags'] = np.array([False, True, True])
  g['turn'] = np.arange(32.0).reshape(2, 4, 4)
  g['text'] = 'words'
  g['one'] = 2.5
  g['image'] = np.zeros((2, 2, 3), 'u1')
  g['steps'] = np.zeros(2, '>u2')
  g['half'] = np.zeros(3, 'f2')
  g['inner'] = h5py.SoftLink('/data/demo_2/one')
  g['nowhere'] = h5py.SoftLink('/data/demo_3')
  g['out'] = h5py.ExternalLink('other.hdf5', '/secret')
  g.create_dataset('raw', shape=(3,), dtype='f8', external=[('raw.bin', 0, 24)])
  g.create_virtual_dataset('virtual', layout)
  g.create_dataset('lzf', data=np.arange(100), compression='lzf')
  g.create_dataset('huge', shape=(10**9, 4), dtype='f4', chunks=(1000, 4))
  g.create_dataset('wide', shape=(10, 10**6), dtype='f8', chunks=(10, 10**6))
  for name, data in (('bomb', zlib.compress(bytes(10**6))), ('short', zlib.compress(bytes(8))), ('noise', os.urandom(400))):
    chunked = g.create_dataset(name, shape=(64,), dtype='f8', chunks=(64,), compression='gzip')
    chunked.id.write_direct_chunk((0,), data)
whole = open('a.hdf5', 'rb').read()
open('cut.hdf5', 'wb').write(whole[:len(whole) // 2])
open('text.hdf5', 'w').write('words')
with h5py.File('latest.hdf5', 'w', libver='latest') as f: f.create_group('data')
whole = bytearray(open('latest.hdf5', 'rb').read())
whole[whole.index(b'OHDR') + 20] ^= 0xff
open('root.hdf5', 'wb').write(whole)
)";

class Hdf5FileTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::filesystem::temp_directory_path() / ("hdf5_file_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "write.py") << kWriter;
    ASSERT_EQ(std::system(("/usr/bin/python3 '" + (folder / "write.py").string() + "' '" +
                           folder.string() + "'")
                              .c_str()),
              0)
        << "is python3-h5py installed?";
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder); }

  static Hdf5File File() { return std::move(Hdf5File::Open((folder / "a.hdf5").string()).value()); }
  static Numbers Read(const std::string& name, const Hdf5Part& part = {}) {
    return File().Read("data/demo_2/" + name, part).value();
  }
  template <class T>
  static std::string ErrorOf(const Result<T>& result) {
    return result ? "" : result.error().front().message + "; " + result.error().front().hint;
  }
  static std::string WhyNot(const std::string& name) {
    return ErrorOf(File().Read("data/demo_2/" + name));
  }

  static std::filesystem::path folder;
};

std::filesystem::path Hdf5FileTest::folder;

TEST_F(Hdf5FileTest, SaysWhatIsThere) {
  const Hdf5File file = File();
  EXPECT_EQ(file.NamesIn("data").value(),
            (std::vector<std::string>{"demo_0", "demo_2", "demo_10"}));
  EXPECT_EQ(file.Describe("data").value().kind, Hdf5Kind::kGroup);
  const auto text = [&](const char* name) {
    return file.Describe(std::string("data/demo_2/") + name).value().Text();
  };
  EXPECT_EQ(text("f4"), "(4, 3) float32");
  EXPECT_EQ(text("flags"), "(3,) bool");
  EXPECT_EQ(text("zipped"), "(250, 4) int64");
  EXPECT_EQ(text("turn"), "(2, 4, 4) float64");
  EXPECT_EQ(text("one"), "() float64");
  EXPECT_EQ(text("image"), "(2, 2, 3) uint8");
  EXPECT_EQ(text("steps"), "(2,) uint16");
  EXPECT_EQ(file.Describe("data/demo_2/turn").value().Width(), 16u);
  EXPECT_TRUE(file.Has("data/demo_10"));
  EXPECT_FALSE(file.Has("data/demo_3"));
}

TEST_F(Hdf5FileTest, ReadsNumbersOfAllTypesAndParts) {
  EXPECT_EQ(Read("f4"), (Numbers{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(Read("f4", {.first = 1, .count = 1}), (Numbers{1, 4, 7, 10}));
  EXPECT_EQ(Read("f4", {.first = 9}), Numbers{});
  EXPECT_EQ(Read("be"), (Numbers{0, 1, 2, 3}));
  EXPECT_EQ(Read("flags"), (Numbers{0, 1, 1}));
  EXPECT_EQ(Read("one"), Numbers{2.5});
  EXPECT_EQ(Read("inner"), Numbers{2.5});
  EXPECT_EQ(Read("zipped", {.first = 3, .count = 1})[99], 399);
  EXPECT_EQ(Read("turn", {.first = 3, .count = 1}), (Numbers{3, 19}));
}

TEST_F(Hdf5FileTest, ReadsAttributes) {
  const Hdf5File file = File();
  const auto value = [&](const char* object, const char* name) {
    return file.Attribute(object, name).value();
  };
  EXPECT_EQ(value("data", "env_args"), Hdf5Value(R"({"env_name": "stack"})"));
  EXPECT_EQ(value("data", "fixed"), Hdf5Value("plain"));
  EXPECT_EQ(value("data", "total"), Hdf5Value(7.0));
  EXPECT_EQ(value("data/demo_2", "success"), Hdf5Value(1.0));
  EXPECT_EQ(value("data/demo_10", "success"), Hdf5Value(0.0));
  EXPECT_FALSE(file.Attribute("data", "none"));
  EXPECT_FALSE(file.Attribute("none", "none"));
}

TEST_F(Hdf5FileTest, ReadsNothingOutsideTheFile) {
  EXPECT_EQ(WhyNot("out"), "'data/demo_2/out' is a link to another file, which is not read; ");
  EXPECT_EQ(WhyNot("raw"), "'data/demo_2/raw' has its data in other files; ");
  EXPECT_EQ(WhyNot("virtual"), "'data/demo_2/virtual' is a virtual dataset, of other files; ");
  EXPECT_FALSE(File().Has("data/demo_2/out"));
}

TEST_F(Hdf5FileTest, NamesWhatIsWrong) {
  EXPECT_EQ(WhyNot("nowhere"), "'data/demo_2/nowhere' is a link to nothing in this file; ");
  EXPECT_NE(
      WhyNot("flag").find("'data/demo_2/flag' is not in the file: 'data/demo_2' has be, bomb"),
      std::string::npos)
      << WhyNot("flag");
  EXPECT_NE(WhyNot("flag").find("; did you mean 'flags'?"), std::string::npos);
  EXPECT_EQ(WhyNot("text"), "'data/demo_2/text' is () text; expected numbers; ");
  EXPECT_EQ(WhyNot("half"), "'data/demo_2/half' is (3,) of another type; expected numbers; ");
  EXPECT_EQ(ErrorOf(File().Read("data")), "'data' is a group; expected a dataset; ");
  EXPECT_EQ(ErrorOf(File().NamesIn("data/demo_2/one")),
            "'data/demo_2/one' is a dataset; expected a group; ");
  EXPECT_NE(WhyNot("lzf").find("is compressed by 'lzf' (filter 32000); gzip"), std::string::npos)
      << WhyNot("lzf");
  const auto open = [&](const char* name) {
    return ErrorOf(Hdf5File::Open((folder / name).string()));
  };
  EXPECT_NE(open("cut.hdf5").find("the file is cut off (truncated file"), std::string::npos)
      << open("cut.hdf5");
  EXPECT_EQ(open("text.hdf5"), "it is no HDF5 file, or is damaged: file signature not found; ");
  EXPECT_EQ(open("."), "it is a folder or a device; expected an HDF5 file; ");
  EXPECT_EQ(open("none.hdf5"), "it does not exist, or cannot be read; ");
}

TEST_F(Hdf5FileTest, LimitsWhatAFileCanCost) {
  EXPECT_EQ(WhyNot("huge"),
            "'data/demo_2/huge' is (1000000000, 4) float32; at most 16777216 values are read; ");
  EXPECT_EQ(WhyNot("wide"), "'data/demo_2/wide' has chunks of more than 67108864 bytes; ");
  for (const char* name : {"bomb", "short", "noise"})
    EXPECT_EQ(WhyNot(name), fmt::format("'data/demo_2/{}' is damaged: a chunk is not as long as it "
                                        "should be; ",
                                        name));
}

TEST_F(Hdf5FileTest, ADamagedRootIsToldOnce) {
  const auto file = Hdf5File::Open((folder / "root.hdf5").string());
  ASSERT_TRUE(file) << "it is opened when it is looked at";
  for (const char* path : {"", "/", "data", "data/demo_0"}) {
    const auto names = file->NamesIn(path);
    ASSERT_FALSE(names) << path;
    EXPECT_NE(names.error().front().message.find("is damaged: "), std::string::npos)
        << names.error().front().message;
  }
}

}  // namespace
}  // namespace prehend::exchange
