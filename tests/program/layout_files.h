// SPDX-License-Identifier: Apache-2.0
// The story of tests/program/carried_cup.h as trackers export it, in each layout and its variants.
#pragma once

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include "tests/program/carried_cup.h"

namespace prehend::house {

inline constexpr int kFrames = 301;
inline constexpr double kRate_hz = 60;
inline constexpr double kTurn_deg = 30;  ///< of the cup, about up, all the time

inline std::string Text(double value, const char* format = "%.6f") {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// One frame after the other; a row of "" is left out.
inline std::string Rows(const std::function<std::string(int)>& row) {
  std::string rows;
  for (int i = 0; i < kFrames; ++i) rows += row(i) + "\n";
  return rows;
}

inline std::string Three(const Row& r, double scale, const std::string& separator,
                         bool y_up = false) {
  const double x = r.x * scale, y = (y_up ? r.z : r.y) * scale, z = (y_up ? -r.y : r.z) * scale;
  return Text(x) + separator + Text(y) + separator + Text(z);
}

struct Motive {
  std::string version = "1.23", unit = "Meters", rotation = "Quaternion";
  double scale = 1;
  bool labels = false;  ///< Type, Name, .. in the first cell, and parents, as 3.x writes them
  std::string end = "\n";
  int lost_from = 0, lost_until = 0;  ///< of the hand
};

inline std::string MotiveCsv(const Motive& m) {
  const bool quaternion = m.rotation == "Quaternion";
  const std::string turn = quaternion ? "Rotation,Rotation,Rotation,Rotation,"
                                      : "Rotation,Rotation,Rotation,",
                    letters = quaternion ? "X,Y,Z,W," : "X,Y,Z,";
  const int each = quaternion ? 8 : 7;
  std::string types, names, ids, parts, axes;
  for (const char* body : {"Hand", "Cup"}) {
    for (int i = 0; i < each; ++i) {
      types += ",Rigid Body";
      names += std::string(",") + body;
      ids += ",\"A1\"";
    }
    parts += "," + turn + "Position,Position,Position,Mean Marker Error";
    axes += "," + letters + "X,Y,Z,";
  }
  types += ",Marker,Marker,Marker";
  names += ",Cup:Marker 001,Cup:Marker 001,Cup:Marker 001";
  ids += ",,,", parts += ",Position,Position,Position", axes += ",X,Y,Z";
  const auto line = [&](const char* label, const std::string& cells) {
    return (m.labels ? std::string(",") + label : std::string(",")) + cells + m.end;
  };
  std::string csv = "Format Version," + m.version +
                    ",Take Name,Take 1,Capture Frame Rate,60.000000,Export Frame Rate,60.000000,"
                    "Rotation Type," +
                    m.rotation + ",Length Units," + m.unit + ",Coordinate Space,Global" + m.end;
  csv += m.end + line("Type", types) + line("Name", names) + line("ID", ids);
  if (m.labels) csv += line("Parent", ids);
  csv += line("", parts) + "Frame,Time (Seconds)" + axes + m.end;
  const double half = kTurn_deg / 2 * 3.14159265358979 / 180;
  for (int i = 0; i < kFrames; ++i) {
    const std::string turned = quaternion
                                   ? "0," + Text(std::sin(half)) + ",0," + Text(std::cos(half))
                                   : "0," + Text(kTurn_deg) + ",0";
    const std::string still = quaternion ? "0,0,0,1" : "0,0,0";
    csv += std::to_string(i) + "," + Text(i / kRate_hz);
    if (i >= m.lost_from && i < m.lost_until)
      csv += std::string(static_cast<std::size_t>(each), ',');
    else
      csv += "," + still + "," + Three(HandAt(i / kRate_hz), m.scale, ",", true) + ",0.0004";
    csv +=
        "," + turned + "," + Three(CupAt(i / kRate_hz), m.scale, ",", true) + ",0.0004,,," + m.end;
  }
  return csv;
}

inline std::string ViconCsv(const std::string& part, const std::string& rotation,
                            const std::string& unit = "rad", const std::string& s = ",") {
  const bool markers = part == "Trajectories", four = rotation == "Quaternion";
  const std::string turn = four ? "RX,RY,RZ,RW," : "RX,RY,RZ,",
                    axes = markers ? "X,Y,Z" : turn + "TX,TY,TZ";
  const std::string before = four ? "Global Angle (Quaternion) " : "";
  const std::string gap = markers ? ",,," : four ? ",,,,,,," : ",,,,,,";
  std::string csv = part + "\n60\n,," + before + "s:Cup" + gap + before + "s:Hand" + gap +
                    "\nFrame,Sub Frame," + axes + "," + axes + "\n,";
  const std::string units = (markers ? ""
                             : four  ? ",,,,"
                                     : "," + unit + "," + unit + "," + unit) +
                            ",mm,mm,mm";
  csv += units + units + "\n";
  const double angle = unit == "deg" ? kTurn_deg : kTurn_deg * 3.14159265358979 / 180;
  const double half = kTurn_deg / 2 * 3.14159265358979 / 180;
  csv += Rows([&](int i) {
    const std::string turned =
        four ? "0,0," + Text(std::sin(half)) + "," + Text(std::cos(half)) + ","
             : "0,0," + Text(angle) + ",";
    const std::string still = four ? "0,0,0,1," : "0,0,0,";
    return std::to_string(i + 1) + ",0," + (markers ? "" : turned) +
           Three(CupAt(i / kRate_hz), 1000, ",") + "," + (markers ? "" : still) +
           Three(HandAt(i / kRate_hz), 1000, ",");
  });
  if (s != ",")
    for (char& c : csv) c = c == ',' ? s[0] : c;
  return csv;
}

struct Qualisys {
  bool six = false, head = true, tab = true, by_rows = false;
  int lost_from = 0, lost_until = 0;
};

inline std::string QualisysTsv(const Qualisys& q) {
  std::string tsv =
      "NO_OF_FRAMES\t301\nNO_OF_CAMERAS\t8\nFREQUENCY\t60\nDESCRIPTION\t--\n"
      "DATA_INCLUDED\t" +
      std::string(q.six ? "6D\nBODY_NAMES" : "3D\nMARKER_NAMES") + "\tCup\tHand\n";
  const std::string end = q.tab ? "\t\n" : "\n";
  if (q.head) {
    tsv += "Frame\tTime";
    for (const char* body : {"Cup", "Hand"}) {
      tsv += std::string("\t") + body + " X\t" +
             (q.six ? "Y\tZ" : std::string(body) + " Y\t" + body + " Z");
      if (q.six) tsv += "\tRoll\tPitch\tYaw\tResidual";
      for (int i = 0; q.six && i < 9; ++i) tsv += "\tRot[" + std::to_string(i) + "]";
    }
    tsv += end;
  }
  const double a = kTurn_deg * 3.14159265358979 / 180, c = std::cos(a), s = std::sin(a);
  const std::string turned = "0\t0\t" + Text(kTurn_deg) + "\t0.3\t" + Text(c) + "\t" +
                             Text(q.by_rows ? -s : s) + "\t0\t" + Text(q.by_rows ? s : -s) + "\t" +
                             Text(c) + "\t0\t0\t0\t1";
  const std::string still = "0\t0\t0\t0.3\t1\t0\t0\t0\t1\t0\t0\t0\t1";
  return tsv + Rows([&](int i) {
           const bool lost = i >= q.lost_from && i < q.lost_until;
           const std::string hand = Three(HandAt(i / kRate_hz), 1000, "\t");
           return (q.head ? std::to_string(i + 1) + "\t" + Text(i / kRate_hz) + "\t" : "") +
                  Three(CupAt(i / kRate_hz), 1000, "\t") + (q.six ? "\t" + turned : "") + "\t" +
                  (lost ? "0.000\t0.000\t0.000" : hand) + (q.six ? "\t" + still : "") +
                  (q.tab ? "\t" : "");
         });
}

inline std::string Trc(const std::string& names, const std::string& unit, double scale,
                       const std::string& blank) {
  return "PathFileType\t4\t(X/Y/Z)\ttake.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\t"
         "OrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n60\t60\t301\t2\t" +
         unit + "\t60\t1\t301\nFrame#\tTime\t" + names + "\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n" + blank +
         Rows([&](int i) {
           return std::to_string(i + 1) + "\t" + Text(i / kRate_hz) + "\t" +
                  Three(CupAt(i / kRate_hz), scale, "\t", true) + "\t" +
                  Three(HandAt(i / kRate_hz), scale, "\t", true);
         });
}

}  // namespace prehend::house
