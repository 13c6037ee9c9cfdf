// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "harness/show/pictures/pictures.h"

namespace prehend::show {
namespace {

namespace fs = std::filesystem;

std::string Slurped(const fs::path& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

TEST(SvgFile, TheEndingSaysWhatIsWritten) {
  const fs::path folder = fs::temp_directory_path() / ("prehend_svg_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const std::string svg =
      "<svg xmlns='http://www.w3.org/2000/svg' width='20' height='10'><rect width='9' "
      "height='9'/></svg>";
  EXPECT_EQ(WriteDrawing(folder / "a.svg", svg), "");
  EXPECT_EQ(Slurped(folder / "a.svg"), svg);
  EXPECT_EQ(WriteDrawing(folder / "a.png", svg), "");
  const std::string png = Slurped(folder / "a.png");
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png[19], 40) << "twice the width";
  EXPECT_EQ(WriteDrawing(folder / "b.png", svg, 6.25), "");
  EXPECT_EQ(Slurped(folder / "b.png")[19], 125) << "600 dots per inch";
  EXPECT_EQ(WriteDrawing(folder / "a.pdf", svg), "");
  EXPECT_EQ(Slurped(folder / "a.pdf").substr(0, 5), "%PDF-");
  EXPECT_NE(WriteDrawing(folder / "c.png", "no drawing"), "");
  EXPECT_FALSE(fs::exists(folder / "c.png"));
  fs::remove_all(folder);
}

TEST(SvgFile, OtherEndingsAreRefused) {
  EXPECT_EQ(WhyNoDrawingFile("x.svg") + WhyNoDrawingFile("a/x.png") + WhyNoDrawingFile("x.pdf"),
            "");
  EXPECT_EQ(WhyNoDrawingFile("x.gif"),
            "found 'x.gif', wanted a file NAME.svg, NAME.png or NAME.pdf");
}

}  // namespace
}  // namespace prehend::show
