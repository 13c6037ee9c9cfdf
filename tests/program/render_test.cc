// SPDX-License-Identifier: Apache-2.0
// What `prehend render` makes besides pictures: timelines, comparisons, films.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class Render : public testing::Test {
 protected:
  ~Render() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  Said Do(std::vector<std::string> words) const {
    words.insert(words.begin(), {"render", "milk_carton_wrap"});
    return Prehend(words);
  }
  void Refused(std::vector<std::string> words, const std::string& why, int code = 2) const {
    const Said said = Do(std::move(words));
    EXPECT_EQ(said.exit_code, code) << said.out;
    EXPECT_TRUE(Has(said.err, "prehend: " + why + "\n")) << said.err;
  }

  const fs::path folder_ =
      FreshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(Render, TheTimelineAlone) {
  const Said said = Do({"--strip", "-o", Path("a.svg")});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(said.out, Path("a.svg") + "\n");
  const std::string all = ReadFile(Path("a.svg"));
  EXPECT_TRUE(Has(all, "transporting") && Has(all, ">milk on<"));
  ASSERT_EQ(Do({"--strip", "--of", "table", "--without", "title", "-o", Path("b.svg")}).exit_code,
            0);
  const std::string part = ReadFile(Path("b.svg"));
  EXPECT_TRUE(Has(part, ">milk on<"));
  EXPECT_FALSE(Has(part, "transporting") || Has(part, "milk_carton_wrap"));
}

TEST_F(Render, ATimelineHasTheWidthOfAColumn) {
  ASSERT_EQ(Do({"--strip", "--width", "89mm", "-o", Path("a.svg")}).exit_code, 0);
  const std::string svg = ReadFile(Path("a.svg"));
  EXPECT_TRUE(Has(svg, "width=\"336.378\"") && Has(svg, "font-size=\"9.33333\"")) << svg;
  Refused({"--width", "89mm"},
          "--width is for --strip, --sheet and --against; a picture has a --size");
  const Said narrow = Do({"--strip", "--width", "3mm"});
  EXPECT_EQ(narrow.exit_code, 2);
  EXPECT_TRUE(Has(narrow.err, "expected a width like 89mm, 30 to 500, found '3mm'")) << narrow.err;
}

TEST_F(Render, OptionsThatDoNotGoTogetherAreRefused) {
  Refused({"--strip", "--film", "a.webp"}, "--strip and --film exclude each other");
  Refused({"--strip", "--camera", "top"}, "--camera does not go with --strip");
  Refused({"--against", "golden", "--at", "1"}, "--at does not go with --against");
  Refused({"--fps", "10"}, "--fps is for --film");
  Refused({"-o", Path("a.svg")}, "--output: found '" + Path("a.svg") +
                                     "', wanted a file NAME.png; scenes are drawn in pixels, "
                                     "--strip is the timeline alone");
  Refused({"--strip", "-o", Path("a.gif")},
          "--output: found '" + Path("a.gif") + "', wanted a file NAME.svg, NAME.png or NAME.pdf");
  Refused({"--strip", "--hand", "foot", "-o", Path("a.svg")},
          "--hand: found 'foot', wanted one of right_hand");
  Refused({"--camera", "1,1,1:1,1,1"},
          "--camera: expected one of front, left, right, top, three_quarter, hand, action, body, "
          "or X,Y,Z:X,Y,Z[:DEG], found '1,1,1:1,1,1'");
  EXPECT_TRUE(fs::is_empty(folder_)) << "nothing was written";
}

TEST_F(Render, ViewsThatCannotBeHadAreRefused) {
  Refused({"--against", "bullet"},
          "--against: milk_carton_wrap is played in bullet already, wanted box2d");
  Refused({"--against", "box2d"},
          "--against: milk_carton_wrap is not planar; only planar scenarios run in both engines");
  const Said grammar = Do({"--against", "nope"});
  EXPECT_EQ(grammar.exit_code, 2);
  EXPECT_TRUE(Has(grammar.err, "no such file")) << grammar.err;
}

class RenderScenes : public Render {
 protected:
  void SetUp() override {
    const Said said = Prehend({"render", "milk_carton_wrap", "-o", Path("try.png")});
    if (Has(said.err, "PREHEND_RENDER=OFF")) GTEST_SKIP() << said.err;
  }
};

TEST_F(RenderScenes, ASheetHasOneTimeline) {
  ASSERT_EQ(Do({"--at", "reaching.begin,grasping.begin,2", "--sheet", "2", "--size", "320x180",
                "-o", Path("a.svg")})
                .exit_code,
            0);
  const std::string svg = ReadFile(Path("a.svg"));
  const auto count = [&](const std::string& part) {
    int found = 0;
    for (std::size_t at = svg.find(part); at != std::string::npos; at = svg.find(part, at + 1))
      ++found;
    return found;
  };
  EXPECT_EQ(count("data:image/png;base64,"), 3);
  EXPECT_EQ(count(">transporting<"), 1);
  EXPECT_EQ(count(">milk on<"), 1);
  EXPECT_TRUE(Has(svg, ">(a) reaching.begin<") && Has(svg, ">(c) 2.00 s<")) << svg;
}

TEST_F(RenderScenes, AnotherGrammarIsBesideThisOne) {
  ASSERT_EQ(Do({"--against", "original_2020", "-o", Path("a.svg")}).exit_code, 0);
  const std::string sheet = ReadFile(Path("a.svg"));
  EXPECT_TRUE(Has(sheet, "milk_carton_wrap: original_2020 and pick_and_place"));
  EXPECT_TRUE(Has(sheet, ") begin of picking_up(right_hand, milk): "));
  EXPECT_TRUE(Has(sheet, ">original_2020: 1.") && Has(sheet, ">pick_and_place: 1."));
  EXPECT_TRUE(Has(sheet, ">difference: "));
  EXPECT_TRUE(Has(sheet, "data:image/png;base64,"));
}

TEST_F(RenderScenes, TheGoldenThatAgreesNeedsNoScenes) {
  ASSERT_EQ(Do({"--against", "golden", "-o", Path("a.svg")}).exit_code, 0);
  const std::string sheet = ReadFile(Path("a.svg"));
  EXPECT_TRUE(Has(sheet, "Both agree: no boundary is off by more than its tolerance"));
  EXPECT_FALSE(Has(sheet, "data:image/png"));
  EXPECT_FALSE(Has(sheet, "(golden)")) << "what both say is one row";
}

TEST_F(RenderScenes, GoldenPicturesAreBesideThoseOfNow) {
  ASSERT_EQ(Do({"--against", "pictures", "-o", Path("a.svg")}).exit_code, 0);
  const std::string same = ReadFile(Path("a.svg"));
  EXPECT_TRUE(Has(same, "milk_carton_wrap: golden pictures and those of now"));
  EXPECT_TRUE(Has(same, ">golden<") && Has(same, ">now<"));
  EXPECT_TRUE(Has(same, ">difference: 0 % of the pixels<")) << "drawn as the golden one was";
  const std::vector<std::string> late = {"--against",       "pictures", "--set",
                                         "lift_height=6cm", "-o",       Path("b.svg")};
  ASSERT_EQ(Do(late).exit_code, 0);
  EXPECT_FALSE(Has(ReadFile(Path("b.svg")), ">difference: 0 % of the pixels<"))
      << "a phase ends earlier";
  const Said none = Prehend({"render", "slide/hop_divides_a_slide", "--against", "pictures"});
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_TRUE(Has(none.err, "has no golden pictures; "));
}

TEST_F(RenderScenes, RegionsOfInterestAreDrawnWhenAsked) {
  const auto picture = [&](const char* name, std::vector<std::string> more) {
    std::vector<std::string> options = {"--at", "reaching.begin", "--size", "320x180",
                                        "-o",   Path(name)};
    options.insert(options.end(), more.begin(), more.end());
    EXPECT_EQ(Do(options).exit_code, 0);
    return ReadFile(Path(name));
  };
  EXPECT_NE(picture("a.png", {}), picture("b.png", {"--look", "regions"}));
  EXPECT_EQ(Do({"--strip", "--look", "regions"}).exit_code, 2);
}

TEST_F(RenderScenes, TheOtherEngineHasScenesOfItsOwn) {
  const Said said = Prehend(
      {"render", "planar/box_is_stacked_on_another", "--against", "bullet", "-o", Path("a.svg")});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  const std::string sheet = ReadFile(Path("a.svg"));
  EXPECT_TRUE(Has(sheet, ">bullet: ") && Has(sheet, ">box2d: ")) << "scenes of both";
}

TEST_F(RenderScenes, ATransparentGroundIsInTheFile) {
  ASSERT_EQ(Do({"--at", "1", "--size", "64x64", "-o", Path("a.png")}).exit_code, 0);
  ASSERT_EQ(
      Do({"--at", "1", "--size", "64x64", "--look", "transparent", "-o", Path("b.png")}).exit_code,
      0);
  constexpr std::size_t kColorType = 25;  // in the header of a PNG
  EXPECT_EQ(ReadFile(Path("a.png"))[kColorType], 2) << "RGB";
  EXPECT_EQ(ReadFile(Path("b.png"))[kColorType], 6) << "RGB with alpha";
}

TEST_F(RenderScenes, FilmsAreFoldersOrFiles) {
  const std::vector<std::string> small = {"--from", "1", "--to",   "1.4",
                                          "--fps",  "5", "--size", "64x64"};
  const auto film = [&](const std::string& path, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"--film", path};
    words.insert(words.end(), small.begin(), small.end());
    words.insert(words.end(), more.begin(), more.end());
    return Do(words);
  };
  ASSERT_EQ(film(Path("frames")).exit_code, 0);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(Path("frames")))
    names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  EXPECT_EQ(names,
            (std::vector<std::string>{"frame_00001.png", "frame_00002.png", "frame_00003.png"}));
  EXPECT_NE(ReadFile(Path("frames/frame_00001.png")), ReadFile(Path("frames/frame_00003.png")));
  EXPECT_TRUE(Has(film(Path("frames")).err, "is not empty, wanted a new folder for the frames"));
  ASSERT_EQ(film(Path("slow"), {"--speed", "0.5"}).exit_code, 0);
  EXPECT_EQ(std::distance(fs::directory_iterator(Path("slow")), fs::directory_iterator()), 5);

  Refused({"--film", Path("a.gif")}, "--film: found '" + Path("a.gif") +
                                         "', wanted NAME.webp, NAME.mp4, or a folder for the "
                                         "frames");
  Refused({"--film", Path("b"), "--speed", "0.01", "--fps", "60"},
          "--film: found 30901 frames, wanted at most 3000; choose a part with --from and --to, a "
          "lower --fps or a higher --speed");
}

TEST_F(RenderScenes, AnEncoderThatIsMissingIsNamed) {
  fs::create_directory(Path("bin"));
  const Said said = Prehend({"render", "milk_carton_wrap", "--film", Path("a.webp"), "--from", "1",
                             "--to", "1.1", "--fps", "5", "--size", "64x64"},
                            {"PATH=" + Path("bin")});
  EXPECT_EQ(said.exit_code, 3) << said.err;
  EXPECT_TRUE(Has(said.err,
                  "no film: 'img2webp' is not installed; Debian's package webp has it, and a name "
                  "without ending is a folder of frames, which needs no other program"))
      << said.err;
  EXPECT_FALSE(fs::exists(Path("a.webp")));
}

TEST_F(RenderScenes, FilmsAreWhatTheirNamesSay) {
  const std::vector<std::string> part = {"--from", "1", "--to",   "1.4",
                                         "--fps",  "5", "--size", "65x65"};
  const auto film = [&](const std::string& name) {
    std::vector<std::string> words = {"--film", Path(name)};
    words.insert(words.end(), part.begin(), part.end());
    return Do(words);
  };
  const Said webp = film("a.webp");
  if (Has(webp.err, "'img2webp' is not installed")) GTEST_SKIP() << webp.err;
  ASSERT_EQ(webp.exit_code, 0) << webp.err;
  const std::string bytes = ReadFile(Path("a.webp"));
  EXPECT_EQ(bytes.substr(0, 4) + bytes.substr(8, 4), "RIFFWEBP");
  EXPECT_TRUE(Has(bytes, "ANIM")) << "it moves";
  const Said mp4 = film("a.mp4");
  if (Has(mp4.err, "'ffmpeg' is not installed")) return;
  ASSERT_EQ(mp4.exit_code, 0) << mp4.err;
  EXPECT_EQ(ReadFile(Path("a.mp4")).substr(4, 4), "ftyp");
}

TEST_F(Render, APictureIsAPngAndARecordingIsRead) {
  Refused({"--at", "1", "-o", Path("x.jpg")},
          "--output: found '" + Path("x.jpg") + "', wanted a file NAME.png");
  WriteFile(Path("a.jsonl"), "{}\n");
  const Said said = Prehend({"render", Path("a.jsonl"), "--at", "1"});
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_TRUE(Has(said.err, "a.jsonl:1:1: error: the first line needs the key 'recording'"))
      << said.err;
  EXPECT_TRUE(Has(Prehend({"render", "--help"}).out, "or a recording"));
}

TEST_F(Render, MissingFoldersAreMade) {
  const Said said = Do({"--strip", "-o", Path("no/folder/a.svg")});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_TRUE(fs::exists(Path("no/folder/a.svg")));
  EXPECT_EQ(Prehend({"grammar", "tracks", "milk_carton_wrap", "--only", "grasping", "-o",
                     Path("no/other/a.csv")})
                .exit_code,
            0);
}

}  // namespace
}  // namespace prehend::house
