// SPDX-License-Identifier: Apache-2.0
// Files of labels that are faulty in ten ways, of each format: found, named, and nothing written.
#include <gtest/gtest.h>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

constexpr const char* kTake =
    R"({"recording": 1, "episode": "e", "ticks_per_second": 100, "entities": {"cup": {"size_m": [0.1, 0.1, 0.1]}, "hand": {"hand": true, "size_m": [0, 0, 0]}}}
{"tick": 0, "samples": {"cup": {"at_m": [0, 0, 0.07]}, "hand": {"at_m": [0, 0, 1]}}}
{"tick": 50, "samples": {"hand": {"at_m": [0, 0, 0.5]}}}
{"end_tick": 300}
)";
constexpr const char* kGrammar =
    "grammar g\nparam close = 5 cm\nevent near(hand: Hand, cup: Thing) while distance(hand, cup) < "
    "close\n";

constexpr const char* kCsv = "begin_s,end_s,label,tier\n0.5,1.5,near,right\n2,2.5,near,right\n";
constexpr const char* kEaf = R"(<?xml version="1.0" encoding="UTF-8"?>
<ANNOTATION_DOCUMENT AUTHOR="a" DATE="2026-01-02T00:00:00+00:00" FORMAT="3.0" VERSION="3.0">
  <HEADER MEDIA_FILE="" TIME_UNITS="milliseconds"/>
  <TIME_ORDER>
    <TIME_SLOT TIME_SLOT_ID="ts1" TIME_VALUE="500"/>
    <TIME_SLOT TIME_SLOT_ID="ts2" TIME_VALUE="1500"/>
  </TIME_ORDER>
  <TIER TIER_ID="right" LINGUISTIC_TYPE_REF="event">
    <ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="a1" TIME_SLOT_REF1="ts1" TIME_SLOT_REF2="ts2">
      <ANNOTATION_VALUE>near</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION>
  </TIER>
  <LINGUISTIC_TYPE LINGUISTIC_TYPE_ID="event" TIME_ALIGNABLE="true"/>
</ANNOTATION_DOCUMENT>
)";
constexpr const char* kTextGrid = R"(File type = "ooTextFile"
Object class = "TextGrid"

xmin = 0
xmax = 3
tiers? <exists>
size = 1
item []:
    item [1]:
        class = "IntervalTier"
        name = "right"
        xmin = 0
        xmax = 3
        intervals: size = 2
        intervals [1]:
            xmin = 0
            xmax = 0.5
            text = ""
        intervals [2]:
            xmin = 0.5
            xmax = 1.5
            text = "near"
)";

struct Fault {
  const char *from, *to;
  const char* says;
};

class FaultyLabels : public testing::Test {
 protected:
  FaultyLabels() {
    WriteFile(folder_ / "take.jsonl", kTake);
    WriteFile(folder_ / "g.grammar", kGrammar);
  }
  Said Margins(const std::string& name, const std::string& text) const {
    WriteFile(folder_ / name, text);
    return Prehend({"grammar", "margins", (folder_ / "take.jsonl").string(), "--truth",
                    (folder_ / name).string(), "--grammar", (folder_ / "g.grammar").string(), "-o",
                    (folder_ / "margins.csv").string()});
  }
  void ExpectEachFaultNamed(const std::string& name, const std::string& good,
                            const std::vector<Fault>& faults) const {
    EXPECT_GE(faults.size(), 8u);  // and two of every format
    EXPECT_EQ(Margins(name, good).exit_code, 0) << Margins(name, good).err;
    std::filesystem::remove(folder_ / "margins.csv");
    const auto expect = [&](const std::string& text, const std::string& says) {
      const Said said = Margins(name, text);
      EXPECT_EQ(said.exit_code, 2) << text << said.out;
      EXPECT_NE(said.err.find(name + ":"), std::string::npos) << says << "\n" << said.err;
      EXPECT_NE(said.err.find(says), std::string::npos) << says << "\n" << said.err;
      EXPECT_EQ(said.out, "");
      EXPECT_FALSE(std::filesystem::exists(folder_ / "margins.csv")) << says;
    };
    for (const Fault& fault : faults) expect(Replaced(good, fault.from, fault.to), fault.says);
    expect("", "");
    expect(good + "\xe9", "byte 0xe9 is not UTF-8");
  }
  const std::filesystem::path folder_ = FreshFolder("faulty_labels");
};

TEST_F(FaultyLabels, OfCsv) {
  ExpectEachFaultNamed(
      "l.csv", kCsv,
      {{"0.5,1.5", "500,1500", "the recording ends after 3 s"},
       {"0.5,1.5", "nan,1.5", "found 'nan', wanted a number"},
       {"0.5,1.5", "0.5,1e999", "found '1e999', wanted a number"},
       {"0.5,1.5", "1.5,0.5", "'near' ends before it begins"},
       {"0.5,1.5,near", "0.5,1.5", "found 3 cells, wanted 4"},
       {"\n2,2.5,near,right\n", "\n2,2.", "found 2 cells, wanted 4"},
       {"\n2,2.5,near,right\n", "\n2,2.5,near\n", "found 3 cells, wanted 4"},
       {"\n2,2.5,near,right\n", "\n2,2.5,near,right,more\n", "found 5 cells, wanted 4"},
       {"\n2,2.5,near,right\n", "\n2,2.5,\"near,right\n", "its quote is not closed"},
       {"\n2,2.5,near,right\n", "\n2,2.5,\"near\" x,right\n",
        "there is more after its closing quote"},
       {"label,tier", "label,label", "two columns are called 'label'"},
       {"1.5,near", "1.5,naer", "naer"},
       {"begin_s", "when", "wanted one for the begin, the end and the label"},
       {"0.5,1.5", "-5,1.5", "the label lies at -5 to 1.5 s"}});
}

TEST_F(FaultyLabels, OfElan) {
  ExpectEachFaultNamed("l.eaf", kEaf,
                       {{"milliseconds", "PAL-frames", "found 'PAL-frames', wanted milliseconds"},
                        {"\"1500\"", "\"1500000\"", "the recording ends after 3 s"},
                        {"\"1500\"", "\"nan\"", "found 'nan', wanted milliseconds"},
                        {"\"500\"", "\"-500\"", "found '-500', wanted milliseconds"},
                        {"\"500\"", "\"2500\"", "ends before it begins"},
                        {"REF2=\"ts2\"", "REF2=\"ts9\"", "there is no time slot 'ts9' with a time"},
                        {"ID=\"ts2\"", "ID=\"ts1\"", "'ts1' is given twice"},
                        {" TIME_VALUE=\"1500\"", "", "there is no time slot 'ts2' with a time"},
                        {"</ANNOTATION_DOCUMENT>\n", "", "it is no XML"},
                        {">near<", ">naer<", "naer"}});
}

TEST_F(FaultyLabels, OfPraat) {
  ExpectEachFaultNamed("l.TextGrid", kTextGrid,
                       {{"\"TextGrid\"", "\"Pitch\"", "wanted ooTextFile, TextGrid"},
                        {"xmax = 1.5", "xmax = 1500", "the recording ends after 3 s"},
                        {"xmax = 1.5", "xmax = \"nan\"", "wanted the end of a label"},
                        {"xmax = 1.5", "xmax = 0.2", "ends before it begins"},
                        {"xmax = 1.5", "xmax = abc", "found abc, wanted the end of a label"},
                        {"xmin = 0.5", "xmin = 0.3", "before the one before it ends, at 0.5 s"},
                        {"\"IntervalTier\"", "\"PitchTier\"", "found a tier of class 'PitchTier'"},
                        {"intervals: size = 2", "intervals: size = 3", "the file ends before"},
                        {"\"near\"", "\"near", "the quote is not closed"},
                        {"<exists>", "<absent>", "it has no tiers"},
                        {"\"near\"", "\"naer\"", "naer"}});
}

}  // namespace
}  // namespace prehend::house
